// A camera from the matrices that renderers have.
#pragma once

#include <array>

#include "limpid/denoise.h"
#include "shaders/common/camera.h"

namespace limpid::denoise {

using Matrix = std::array<double, 16>;  ///< column-major

struct CameraMatrices {
    CameraParams params{};
    std::array<vec4, 3> clip{};  ///< rows x, y and w of the matrix from world to clip space; y points down
    std::array<vec3, 3> axes{};  ///< of view space in the world
    vec4 deviceDepth{};          ///< of the projection: elements zz, zw, wz, ww (row, column)
    bool reversed = false;       ///< depth is 0 at the far end
};

/// `view` from world to view space, rigid; `projection` to clip space, perspective or orthographic, also
/// off-centre. Throws UsageError if a matrix is singular or has a NaN.
CameraMatrices cameraFromMatrices(const float (&view)[16], const float (&projection)[16], bool yUp,
                                  uint32_t height);

}  // namespace limpid::denoise
