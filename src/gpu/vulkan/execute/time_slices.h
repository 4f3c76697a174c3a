// How a frame is cut into short submissions where its caller wants to be able to interrupt it: slow devices
// take seconds for a pass, and what was submitted cannot be taken back.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace limpid::gpu {

class TimeSlices {
  public:
    /// Intended length of a submission.
    static constexpr double sliceSeconds = 0.03;

    explicit TimeSlices(std::function<bool()> ask) : interrupted(std::move(ask)) {}

    std::function<bool()> interrupted;
    /// The number of rows of workgroups, of those that remain, that the next submission of a pass should
    /// have.
    uint32_t rows(const std::string& pass, uint64_t groupsPerRow, uint32_t remaining) const;
    /// The expected time of so many groups; 0 if the pass was never timed.
    double seconds(const std::string& pass, uint64_t groups) const;
    /// So many groups took so long.
    void note(const std::string& pass, uint64_t groups, double seconds);

    /// Expected time of what was recorded since the last submission.
    double pending = 0.0;

  private:
    std::map<std::string, double> secondsPerGroup_;
};

}  // namespace limpid::gpu
