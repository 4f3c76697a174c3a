// `limpid denoise` in parts of a shot, by one process or several.
#pragma once

#include <cstdint>
#include <vector>

#include "shot/run/denoise_shot.h"

namespace limpid::cli {

/// Denoises the frames that the job writes in windows of this many frames, each after a run-up as shards have
/// (0: all in one; 32 frames if there are several processes). Which process makes which window changes
/// nothing. Returns the summary of all, on process 0, and how many windows each process made, if there are
/// several. Sets the job's progress.
shot::ShotSummary denoiseInWindows(shot::ShotJob& job, size_t windowFrames, gpu::Device& device,
                                   std::vector<uint64_t>& madeByProcess);

}  // namespace limpid::cli
