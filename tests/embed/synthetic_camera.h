// Converts the tests' cameras to the view and projection matrices that the C interface takes.
#pragma once

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "limpid/denoise.h"
#include "shaders/common/camera.h"

namespace limpid::test {

inline glm::dmat4 viewOf(const CameraParams& camera) {
    const glm::dvec3 eye(camera.origin), forward(camera.forward), up(camera.up);
    return glm::lookAtRH(eye, eye + forward, up);
}

/// Returns a projection to Vulkan's clip space: y points down, depth is from 0 to 1.
inline glm::dmat4 projectionOf(const CameraParams& camera) {
    const double x = glm::length(glm::dvec3(camera.right)), y = glm::length(glm::dvec3(camera.up));
    constexpr double near = 0.01, far = 1000.0;
    glm::dmat4 p = camera.orthographic != 0u
                       ? glm::orthoRH_ZO(-x, x, -y, y, near, far)
                       : glm::frustumRH_ZO(-near * x, near * x, -near * y, near * y, near, far);
    for (int column = 0; column < 4; ++column) p[column][1] = -p[column][1];
    return p;
}

inline void copyMatrix(const glm::dmat4& from, float (&to)[16]) {
    for (int i = 0; i < 16; ++i) to[i] = static_cast<float>(glm::value_ptr(from)[i]);
}

inline limpid_camera matricesOf(const CameraParams& now, const CameraParams& before) {
    limpid_camera camera{};
    copyMatrix(viewOf(now), camera.view);
    copyMatrix(projectionOf(now), camera.projection);
    copyMatrix(viewOf(before), camera.previous_view);
    copyMatrix(projectionOf(before), camera.previous_projection);
    return camera;
}

}  // namespace limpid::test
