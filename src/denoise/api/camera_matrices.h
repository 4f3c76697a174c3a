// Derives a camera from a renderer's matrices.
#pragma once

#include <array>

#include "limpid/denoise.h"
#include "shaders/common/camera.h"

namespace limpid::denoise {

using Matrix = std::array<double, 16>;  ///< column-major

struct CameraMatrices {
    CameraParams params{};
    std::array<vec4, 3> clip{};  ///< rows x, y and w of the world-to-clip matrix; y points down
    std::array<vec3, 3> axes{};  ///< axes of view space in world space
    vec4 deviceDepth{};          ///< elements zz, zw, wz, ww (row, column) of the projection
    bool reversed = false;       ///< depth is 0 at the far end
};

/// `view` maps world to view space and is rigid; `projection` maps to clip space and is perspective or
/// orthographic, possibly off-centre. Throws UsageError if a matrix is singular, contains NaN or is not of
/// this kind (limpid_camera), naming it with `prefix` before "view" or "projection".
CameraMatrices cameraFromMatrices(const float (&view)[16], const float (&projection)[16], bool yUp,
                                  uint32_t height, const char* prefix = "");

}  // namespace limpid::denoise
