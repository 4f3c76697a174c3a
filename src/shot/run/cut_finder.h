// Where a shot changes.
#pragma once

#include <optional>

#include "shot/run/shot_job.h"

namespace limpid::shot {

/// Notices cuts between neighbouring frames, in either direction: it keeps the last frame's layers without
/// noise.
class CutFinder {
  public:
    explicit CutFinder(const ShotJob& job) : job_(job) {}

    /// True if the frame and that of the last call belong to different shots.
    bool isCut(const LoadedFrame& frame);

  private:
    const ShotJob& job_;
    std::optional<ShotLayers> last_;
    int number_ = 0;
};

}  // namespace limpid::shot
