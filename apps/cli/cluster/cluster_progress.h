// Progress of all processes together, on process 0.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "cli/console/progress.h"

namespace limpid::cli {

/// A line on a terminal, as Progress. Launchers give processes a pipe instead of a terminal; there, a message
/// every ten seconds. Nothing on other processes. From any thread.
class ClusterProgress {
  public:
    ClusterProgress(std::string unit, uint64_t total);
    void show(uint64_t done);

  private:
    using Clock = std::chrono::steady_clock;
    std::mutex mutex_;
    Progress line_;
    std::string unit_;
    uint64_t total_;
    bool terminal_;
    Clock::time_point start_ = Clock::now(), said_ = start_;
};

}  // namespace limpid::cli
