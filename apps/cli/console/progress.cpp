#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace limpid::cli {

std::string durationText(double seconds) {
    const auto whole = static_cast<uint64_t>(std::min(std::max(seconds, 0.0), 1e9) + 0.5);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
    if (whole < 24 * 3600) return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
    return fmt::format("{} d {} h", whole / 86400, whole % 86400 / 3600);
}

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
    fmt::print(stderr, "\r\x1b[K[{:#<{}}{:.<{}}] {}/{} {}, {:.1f} a second, {} left", "", filled, "",
               width - filled, done, total_, unit_, rate, durationText(left));
    std::fflush(stderr);
}

}  // namespace limpid::cli
