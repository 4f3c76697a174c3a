#include "scene/model/camera.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/prepare/mesh_repair.h"

namespace limpid::scene {

CameraParams cameraParams(const Camera& camera, uint32_t width, uint32_t height) {
    const float halfHeight = camera.orthographic ? camera.halfHeight : std::tan(0.5f * camera.verticalFov);
    const float halfWidth = halfHeight * static_cast<float>(width) / static_cast<float>(height);
    CameraParams params{};
    params.origin = vec3(camera.toWorld[3]);
    params.orthographic = camera.orthographic ? 1u : 0u;
    params.forward = -glm::normalize(vec3(camera.toWorld[2]));
    params.right = halfWidth * glm::normalize(vec3(camera.toWorld[0]));
    params.up = halfHeight * glm::normalize(vec3(camera.toWorld[1]));
    params.spread = 2.0f * halfHeight / static_cast<float>(height);
    params.lensRadius = 0.5f * camera.lensDiameter;
    params.focusDistance = camera.lensDiameter > 0.0f ? camera.focusDistance : 0.0f;
    return params;
}

Camera lookAt(const vec3& eye, const vec3& target, const vec3& up, float verticalFov) {
    Camera camera;
    camera.toWorld = glm::inverse(glm::lookAt(eye, target, up));
    camera.verticalFov = verticalFov;
    camera.focusDistance = glm::distance(eye, target);
    return camera;
}

Camera withLens(Camera camera, const Lens& lens) {
    constexpr float millimetre = 1e-3f;
    if (lens.focalLength > 0.0f)
        camera.verticalFov = 2.0f * std::atan(lens.sensorHeight / (2.0f * lens.focalLength));
    if (lens.focusDistance > 0.0f) camera.focusDistance = lens.focusDistance;
    if (lens.diameter >= 0.0f) camera.lensDiameter = lens.diameter;
    if (lens.fStop > 0.0f) {
        const float focalLength = lens.sensorHeight / (2.0f * std::tan(0.5f * camera.verticalFov));
        camera.lensDiameter = millimetre * focalLength / lens.fStop;
    }
    return camera;
}

mat4 withoutScale(const mat4& m) {
    vec3 back = safeNormalize(vec3(m[2]));
    if (back == vec3(0.0f)) back = {0, 0, 1};
    vec3 up = safeNormalize(vec3(m[1]));
    up = safeNormalize(up - back * glm::dot(up, back));
    if (up == vec3(0.0f)) up = anyPerpendicular(back);
    // Computed from the other two axes: a mirrored transform must not mirror the picture.
    return {vec4(glm::cross(up, back), 0), vec4(up, 0), vec4(back, 0), vec4(vec3(m[3]), 1)};
}

}  // namespace limpid::scene
