// How the files of a shot are understood: `limpid denoise --explain`.
#pragma once

#include <string>

#include "shot/run/shot_job.h"

namespace limpid::shot {

/// Several lines on the first frame, and with a second one on the motion. Throws InputError.
std::string explainShot(const ShotJob& job);

}  // namespace limpid::shot
