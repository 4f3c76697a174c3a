// The clock that durations are measured with.
#pragma once

#include <chrono>

namespace limpid {

using Clock = std::chrono::steady_clock;

inline double secondsSince(Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
}

}  // namespace limpid
