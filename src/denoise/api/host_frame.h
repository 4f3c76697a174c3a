// One frame of what denoisers read, in host memory: from EXR files, from other renderers, in tests.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "shaders/common/camera.h"

namespace limpid::denoise {

/// Four floats a pixel unless said otherwise, row 0 first; docs/denoising.md says what each is. The fourth of
/// diffuse, specular, albedo, normal and depth is read by networks only (DenoiserInput::samples).
struct HostFrame {
    uint32_t width = 0, height = 0;
    std::vector<float> diffuse, specular, emission;  ///< linear radiance
    std::vector<float> albedo;
    std::vector<float> albedoSpecular;    ///< as albedo; empty: zeros
    std::vector<float> normal;            ///< world space, facing the viewer; 0 at a miss
    std::vector<float> depth;             ///< x: distance from the eye times y; y: share of hits (0 or 1)
    std::vector<float> motion;            ///< xyz times w; w: share of valid samples (0 or 1)
    std::vector<float> reflectionMotion;  ///< likewise, of what the surface reflects; empty: zeros
    std::vector<float> previousNormal;    ///< of the same surface points in the previous frame
    std::vector<uint32_t> ids;            ///< two a pixel: instance, material; UINT32_MAX at a miss
    CameraParams camera{};
    uint32_t samples = 1;  ///< per pixel

    size_t pixelCount() const { return size_t{width} * height; }
};

}  // namespace limpid::denoise
