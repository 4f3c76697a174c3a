// How long frames and their passes have taken lately: for graphs.
#pragma once

#include <string>
#include <vector>

#include "base/clock.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::studio {

/// True once `seconds` have gone by since `last`, which is now then.
bool due(Clock::time_point& last, double seconds);

/// For the user: three digits, and seconds from one second on.
std::string durationText(float milliseconds);

/// The last values, oldest first.
class Track {
  public:
    static constexpr size_t maxValues = 120;
    void add(float value);
    const std::vector<float>& values() const { return values_; }
    float last() const { return values_.empty() ? 0.0f : values_.back(); }

  private:
    std::vector<float> values_;
};

struct PassTrack {
    std::string name;
    Track milliseconds;  ///< of all passes of this name in a frame
};

class Timings {
  public:
    /// From one frame to the next, milliseconds.
    void addFrame(double milliseconds) { frames_.add(static_cast<float>(milliseconds)); }
    /// Of one frame. Passes that it has not are forgotten; all stand in the frame's order.
    void addPasses(const std::vector<gpu::PassTime>& times);

    const Track& frames() const { return frames_; }
    const std::vector<PassTrack>& passes() const { return passes_; }

  private:
    Track frames_;
    std::vector<PassTrack> passes_;
};

}  // namespace limpid::studio
