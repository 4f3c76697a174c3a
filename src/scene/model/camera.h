// Converts a scene's camera to the parameters that shaders read.
#pragma once

#include "scene/model/scene.h"
#include "shaders/common/camera.h"

namespace limpid::scene {

/// For an image of width x height pixels. Perspective cameras keep their verticalFov at any aspect ratio.
CameraParams cameraParams(const Camera& camera, uint32_t width, uint32_t height);

/// Returns a camera at `eye` looking at `target`; `up` need not be perpendicular to the view.
Camera lookAt(const vec3& eye, const vec3& target, const vec3& up, float verticalFov);

/// Returns the same position and orientation, with orthonormal axes.
mat4 withoutScale(const mat4& toWorld);

}  // namespace limpid::scene
