// One frame of denoiser inputs in host memory, from EXR files, other renderers or tests.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/layers/layer_set.h"
#include "shaders/common/camera.h"

namespace limpid::denoise {

/// A member for each layer of base/layers/layer_table.h: four floats per pixel (two integers for `ids`), row
/// 0 first. docs/denoising.md describes them. Optional layers may be empty, which means zeros; roughness and
/// hit distance are then unknown. The fourth float of diffuse, specular, albedo, normal and depth is for
/// kpcn, that of the first two for other methods, too (DenoiserInput::samples, variances).
struct HostFrame : LayerSet<std::vector<float>, std::vector<uint32_t>> {
    uint32_t width = 0, height = 0;
    CameraParams camera{};
    uint32_t samples = 1;    ///< per pixel
    bool variances = false;  ///< DenoiserInput::variances
    /// DenoiserInput::jitter, if it changes from frame to frame; empty if not, and if that is unknown.
    std::optional<vec2> jitter;

    size_t pixelCount() const { return size_t{width} * height; }
};

}  // namespace limpid::denoise
