// Reads the frames of a shot ahead.
#pragma once

#include <future>
#include <optional>
#include <set>

#include "shot/run/shot_job.h"

namespace limpid::shot {

/// Reads frames, each while the last one is used.
class FrameReader {
  public:
    explicit FrameReader(const ShotJob& job) : job_(job) {}

    /// Returns the frame job.frames[index], and begins to read job.frames[next] if there is one. Nothing if
    /// the frame is unreadable and to be skipped, or only makes histories; else throws InputError for it.
    std::optional<LoadedFrame> read(size_t index, std::optional<size_t> next);

    /// Of the frames that the user asks for.
    const std::set<int>& skipped() const { return skipped_; }

  private:
    void start(size_t index);

    const ShotJob& job_;
    std::future<LoadedFrame> reading_;
    size_t ahead_ = 0;
    std::set<int> skipped_, leftOut_;  ///< leftOut_: those that only make histories
};

}  // namespace limpid::shot
