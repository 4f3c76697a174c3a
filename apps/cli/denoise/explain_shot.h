// `limpid denoise --explain`.
#pragma once

#include "cli/denoise/denoise_shot.h"

namespace limpid::cli {

/// Prints how the first frame, and with a second one the motion, are understood.
void explainShot(const ShotJob& job);

}  // namespace limpid::cli
