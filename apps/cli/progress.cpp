#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace limpid::cli {

Progress::Progress(std::string unit, uint64_t total)
    : unit_(std::move(unit)), total_(total), terminal_(::isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
    if (terminal_ && drawn_ != Clock::time_point{}) fmt::print(stderr, "\r\x1b[K");
}

void Progress::show(uint64_t done) {
    const Clock::time_point now = Clock::now();
    if (!terminal_ || now - drawn_ < std::chrono::milliseconds(100)) return;
    drawn_ = now;
    constexpr uint64_t width = 30;
    const uint64_t filled = total_ > 0 ? width * done / total_ : width;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double rate = seconds > 0.0 ? static_cast<double>(done) / seconds : 0.0;
    const double left = rate > 0.0 ? static_cast<double>(total_ - done) / rate : 0.0;
    fmt::print(stderr, "\r\x1b[K[{:#<{}}{:.<{}}] {}/{} {}, {:.1f} a second, {:.0f} s left", "", filled, "",
               width - filled, done, total_, unit_, rate, left);
    std::fflush(stderr);
}

}  // namespace limpid::cli
