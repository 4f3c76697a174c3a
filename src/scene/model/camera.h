// From a scene's camera to what shaders read.
#pragma once

#include "scene/model/scene.h"
#include "shaders/common/camera.h"

namespace limpid::scene {

/// For an image of width x height pixels. Perspective: verticalFov holds at any aspect ratio.
CameraParams cameraParams(const Camera& camera, uint32_t width, uint32_t height);

/// A camera at `eye` looking at `target`; `up` need not be perpendicular.
Camera lookAt(const vec3& eye, const vec3& target, const vec3& up, float verticalFov);

/// The same place and view, with axes of unit length at right angles.
mat4 withoutScale(const mat4& toWorld);

}  // namespace limpid::scene
