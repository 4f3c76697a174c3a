// The path tracer of src/passes/pathtrace for diffuse scenes, native, on Embree's single rays. It draws the
// same random numbers in the same order, so its paths are ours up to rounding.
#pragma once

#include <span>

#include "embree_scene.h"
#include "shaders/common/camera.h"

namespace limpid::bench {

/// One sample per pixel. Members mean what those of PathtraceLaunch and PathtraceSettings mean.
struct EmbreeLaunch {
    CameraParams camera;
    uint32_t width = 0;
    uint32_t height = 0;
    uint32_t frame = 0;
    uint32_t seed = 0;
    uint32_t maxDepth = 4;
    uint32_t rouletteDepth = 3;
};

/// Adds each pixel's radiance to `sum` (width * height, row 0 at the top; w counts the samples that were
/// finite) on all cores. Returns how many rays were traced, shadow rays too. Throws Error if `sum` has
/// another size.
uint64_t traceSample(const EmbreeScene& scene, const EmbreeLaunch& launch, std::span<vec4> sum);

}  // namespace limpid::bench
