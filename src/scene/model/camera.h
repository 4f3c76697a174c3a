// Converts a scene's camera to the parameters that shaders read.
#pragma once

#include "scene/model/scene.h"
#include "shaders/common/camera.h"

namespace limpid::scene {

/// For an image of width x height pixels. Perspective cameras keep their verticalFov at any aspect ratio.
CameraParams cameraParams(const Camera& camera, uint32_t width, uint32_t height);

/// Returns a camera at `eye` looking at `target`; `up` need not be perpendicular to the view. Its
/// focusDistance is that of `target`; it has no lens.
Camera lookAt(const vec3& eye, const vec3& target, const vec3& up, float verticalFov);

/// A photographic lens, for withLens().
struct Lens {
    float fStop = 0.0f;          ///< focal length over diameter; 0: not given
    float diameter = -1.0f;      ///< world units; 0: a pinhole; below: not given
    float focusDistance = 0.0f;  ///< world units, along the view; 0: not given
    float focalLength = 0.0f;    ///< mm; 0: from the camera's field of view
    float sensorHeight = 24.0f;  ///< mm
};

/// Returns the camera with this lens; what is not given stays. The field of view is that of a lens focused at
/// infinity, 2 atan(sensorHeight / (2 focalLength)), at every focus distance. An f-number's diameter takes a
/// world unit for a metre. Perspective cameras only.
Camera withLens(Camera camera, const Lens& lens);

/// Returns the same position and orientation, with orthonormal axes.
mat4 withoutScale(const mat4& toWorld);

}  // namespace limpid::scene
