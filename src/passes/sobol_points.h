// The points of --sampler sobol that all pixels of a launch share.
#pragma once

#include "passes/camera_launch.h"
#include "shaders/common/sobol_table.h"

namespace limpid {

/// The samples of a launch.
struct SobolSamples {
    uint32_t first = 0;            ///< number of the first sample: CameraLaunch::firstPoint
    uint32_t count = 1;            ///< per pixel in this launch
    uint32_t draws = SOBOL_DRAWS;  ///< of each sample, at most SOBOL_DRAWS
};

/// With more samples per launch, the table has room for fewer draws of each.
inline constexpr uint32_t maxSobolSamplesPerLaunch = SOBOL_POINTS / SOBOL_DRAWS;

/// Returns the table for a launch; all zero for samplers that need none.
SobolTable sobolTable(Sampler sampler, uint32_t seed, const SobolSamples& samples);

}  // namespace limpid
