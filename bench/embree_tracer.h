// A native version of the path tracer in src/passes/pathtrace for diffuse scenes, on Embree's single rays. It
// uses the same random numbers in the same order, so its paths are the same up to rounding.
#pragma once

#include <span>

#include "embree_scene.h"
#include "shaders/common/camera.h"

namespace limpid::bench {

/// One sample per pixel. The members have the same meaning as in PathtraceLaunch and PathtraceSettings.
struct EmbreeLaunch {
    CameraParams camera;
    uint32_t width = 0;
    uint32_t height = 0;
    uint32_t frame = 0;
    uint32_t seed = 0;
    uint32_t maxDepth = 4;
    uint32_t rouletteDepth = 3;
};

/// Adds each pixel's radiance to `sum` (width * height, row 0 at the top; w counts the finite samples), using
/// all cores. Returns the number of rays traced, including shadow rays. Throws Error if `sum` has another
/// size.
uint64_t traceSample(const EmbreeScene& scene, const EmbreeLaunch& launch, std::span<vec4> sum);

}  // namespace limpid::bench
