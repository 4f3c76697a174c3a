// A progress line on stderr, when stderr is a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace limpid::cli {

/// "42 s", "3 min 20 s", "2 h 5 min", "1 d 3 h".
std::string durationText(double seconds);

class Progress {
  public:
    /// `unit` is what is counted: "samples".
    Progress(std::string unit, uint64_t total);
    ~Progress();  ///< clears the line
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Redraws at most ten times a second.
    void show(uint64_t done);

  private:
    using Clock = std::chrono::steady_clock;
    std::string unit_;
    uint64_t total_;
    bool terminal_;
    Clock::time_point start_ = Clock::now(), drawn_{};
};

}  // namespace limpid::cli
