// Reads, denoises and writes the frames of a shot: the next frame is read and the last one written while one
// is denoised.
#pragma once

#include <vector>

#include "shot/run/shot_job.h"

namespace limpid::shot {

struct ShotSummary {
    int frames = 0;        ///< written
    int kept = 0;          ///< found complete
    bool stopped = false;  ///< by ShotJob::progress
    double seconds = 0.0;
    std::vector<int> skipped, cuts;
};

/// Throws InputError if a frame cannot be read and is not to be skipped; frames before it are complete.
/// Bidirectional shots are denoised in blocks, which bounds the memory: each block first backwards, beginning
/// some frames behind its end, then forwards.
/// If all frames are skipped, throws InputError, unless the job writes only a part of what is asked for:
/// other parts may have readable ones.
ShotSummary denoiseShot(const ShotJob& job, gpu::Device& device);

/// For who runs a job in parts: throws that InputError. `summary` is of the whole job.
void checkSomeFrameWasRead(const ShotJob& job, const ShotSummary& summary);

}  // namespace limpid::shot
