// Writes the clean frames of a shot.
#pragma once

#include <functional>
#include <future>
#include <optional>
#include <vector>

#include "shot/run/frame_reader.h"
#include "shot/run/shot_job.h"

namespace limpid::shot {

/// What is written of one frame.
struct FrameToWrite {
    uint64_t content = 0;  ///< LoadedFrame::content
    image::ExrDocument file;
    std::vector<LayerMap> maps;
    std::vector<CleanPicture> pictures;
    std::vector<float> surfaces;  ///< 1 where a surface is seen, for the exposure of a PNG; empty: unknown
};

/// Writes frames, each while the next one is denoised.
class FrameWriter {
  public:
    explicit FrameWriter(const ShotJob& job) : job_(job) {}

    /// Throws what writing the frame before threw.
    void write(int number, FrameToWrite frame);

    /// Waits. Throws what writing threw.
    void finish();

  private:
    const ShotJob& job_;
    std::future<void> writing_;
};

/// FrameToWrite::surfaces of a frame.
std::vector<float> surfacesOf(const LoadedFrame& frame);

/// The index of the first frame whose output is not complete: EXR files say of which input and settings they
/// are. Frames that the reader skips are passed over, as there is nothing to write. Asks `goesOn` before each
/// frame; nothing if that is false.
std::optional<size_t> firstIncomplete(const ShotJob& job, FrameReader& reader,
                                      const std::function<bool()>& goesOn);

}  // namespace limpid::shot
