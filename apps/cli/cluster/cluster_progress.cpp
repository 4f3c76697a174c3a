#include "cli/cluster/cluster_progress.h"

#include <unistd.h>

#include "base/log.h"
#include "cli/cluster/session.h"

namespace limpid::cli {
namespace {
constexpr std::chrono::seconds messageEvery{10};
}

ClusterProgress::ClusterProgress(std::string unit, uint64_t total)
    : line_(unit, total), unit_(std::move(unit)), total_(total), terminal_(::isatty(STDERR_FILENO) != 0) {}

void ClusterProgress::show(uint64_t done) {
    if (!isFirstProcess()) return;
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    if (terminal_) return line_.show(done);
    if (!ranks() || now - said_ < messageEvery || done == 0) return;
    said_ = now;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const double left = seconds * static_cast<double>(total_ - done) / static_cast<double>(done);
    log::info("{} of {} {} by {} processes, {} left", done, total_, unit_, ranks()->place().size,
              durationText(left));
}

}  // namespace limpid::cli
