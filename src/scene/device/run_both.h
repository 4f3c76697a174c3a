// Functions at the same time, each of which may throw.
#pragma once

#include <tbb/parallel_invoke.h>

#include <cstddef>
#include <exception>

namespace limpid::scene {

/// Runs both, and throws what `first` threw, or else `second`, once both have returned.
/// tbb::parallel_invoke() would cancel the other one: TBB's loops in it would return before they are done,
/// without telling it, and it would continue with results that were never computed.
template <typename First, typename Second>
void runBoth(const First& first, const Second& second) {
    const auto kept = [](const auto& function, std::exception_ptr& fault) {
        try {
            function();
        } catch (...) {
            fault = std::current_exception();
        }
    };
    std::exception_ptr faultOfFirst, faultOfSecond;
    tbb::parallel_invoke([&] { kept(first, faultOfFirst); }, [&] { kept(second, faultOfSecond); });
    if (faultOfFirst) std::rethrow_exception(faultOfFirst);
    if (faultOfSecond) std::rethrow_exception(faultOfSecond);
}

/// Calls use(first) to use(first + count - 1) at the same time. All are called, even if one throws; then
/// throws what the first of them threw.
template <typename Use>
void runAll(size_t count, const Use& use, size_t first = 0) {
    if (count == 0) return;
    if (count == 1) return use(first);
    const size_t half = count / 2;
    runBoth([&] { runAll(half, use, first); }, [&] { runAll(count - half, use, first + half); });
}

}  // namespace limpid::scene
