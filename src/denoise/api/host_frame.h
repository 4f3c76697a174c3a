// One frame of what denoisers read, in host memory: from EXR files, from other renderers, in tests.
#pragma once

#include <cstdint>
#include <vector>

#include "base/layers/layer_set.h"
#include "shaders/common/camera.h"

namespace limpid::denoise {

/// A member for each layer of base/layers/layer_table.h: four floats a pixel (of `ids` two integers), row 0
/// first; docs/denoising.md says what each is. Optional layers may be empty: zeros. The fourth float of
/// diffuse, specular, albedo, normal and depth is read by networks only (DenoiserInput::samples).
struct HostFrame : LayerSet<std::vector<float>, std::vector<uint32_t>> {
    uint32_t width = 0, height = 0;
    CameraParams camera{};
    uint32_t samples = 1;  ///< per pixel

    size_t pixelCount() const { return size_t{width} * height; }
};

}  // namespace limpid::denoise
