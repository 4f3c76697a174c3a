#include "studio/camera/fly_camera.h"

#include <algorithm>
#include <cmath>

#include "scene/model/camera.h"

namespace limpid::studio {
namespace {

constexpr float steepest = 1.55f;  // radians: just short of the poles, where "up" has no direction
constexpr vec3 worldUp(0.0f, 1.0f, 0.0f);

/// A camera without roll turns about the world's vertical, a rolled one about its own.
vec3 horizonOf(const scene::Camera& camera) {
    const vec3 right(camera.toWorld[0]), up(camera.toWorld[1]);
    return std::abs(right.y) < 1e-3f && up.y > -1e-3f ? worldUp : glm::normalize(up);
}

/// Returns columns: right, up and back of a camera that looks along the horizon.
mat3 axesOver(const vec3& up) {
    if (up == worldUp) return mat3(1.0f);
    const vec3 other = std::abs(up.z) < 0.9f ? vec3(0.0f, 0.0f, 1.0f) : vec3(1.0f, 0.0f, 0.0f);
    const vec3 right = glm::normalize(glm::cross(up, other));
    return {right, up, glm::cross(right, up)};
}

}  // namespace

FlyCamera::FlyCamera(const scene::Camera& start, float distance)
    : start_(start),
      eye_(start.toWorld[3]),
      axes_(axesOver(horizonOf(start))),
      distance_(std::max(distance, 1e-6f)) {
    face(-vec3(start.toWorld[2]));
}

/// `direction` is a unit vector.
void FlyCamera::face(const vec3& direction) {
    const vec3 ahead = direction * axes_;  // relative to the axes
    yaw_ = std::atan2(ahead.x, -ahead.z);
    pitch_ = std::clamp(std::asin(std::clamp(ahead.y, -1.0f, 1.0f)), -steepest, steepest);
}

bool FlyCamera::place(const vec3& eye, const vec3& target, const vec3& up) {
    const float distance = glm::distance(eye, target);
    const vec3 sideways = glm::cross(target - eye, up);
    if (!(distance > 1e-6f && glm::length(up) > 0.0f &&
          glm::length(sideways) > 1e-4f * distance * glm::length(up)))
        return false;
    eye_ = eye;
    distance_ = distance;
    axes_ = axesOver(glm::normalize(up));
    face((target - eye) / distance);
    return true;
}

void FlyCamera::focus(const vec3& point) {
    const float distance = glm::distance(point, eye_);
    if (distance < 1e-6f) return;
    face((point - eye_) / distance);
    distance_ = distance;
}

vec3 FlyCamera::forward() const {
    return axes_ *
           vec3(std::cos(pitch_) * std::sin(yaw_), std::sin(pitch_), -std::cos(pitch_) * std::cos(yaw_));
}

vec3 FlyCamera::right() const {
    return axes_ * vec3(std::cos(yaw_), 0.0f, std::sin(yaw_));
}

void FlyCamera::look(float rightward, float up) {
    yaw_ = std::remainder(yaw_ + rightward, 6.28318531f);
    pitch_ = std::clamp(pitch_ + up, -steepest, steepest);
}

void FlyCamera::orbit(float rightward, float up) {
    const vec3 middle = target();
    look(rightward, up);  // the eye moves the other way, so that the scene follows the mouse
    eye_ = middle - distance_ * forward();
}

void FlyCamera::pan(float rightward, float up) {
    const float height = start_.orthographic ? 2.0f * start_.halfHeight
                                             : 2.0f * distance_ * std::tan(0.5f * start_.verticalFov);
    eye_ -= height * (rightward * right() + up * glm::cross(right(), forward()));
}

void FlyCamera::zoom(float factor) {
    const vec3 middle = target();
    distance_ = std::max(distance_ * factor, 1e-6f);
    eye_ = middle - distance_ * forward();
    if (start_.orthographic) start_.halfHeight *= factor;
}

void FlyCamera::move(const vec3& rightUpForward) {
    eye_ += rightUpForward.x * right() + rightUpForward.y * up() + rightUpForward.z * forward();
}

void FlyCamera::setHalfHeight(float halfHeight) {
    start_.orthographic = halfHeight > 0.0f;
    if (start_.orthographic) start_.halfHeight = halfHeight;
}

scene::Camera FlyCamera::camera() const {
    scene::Camera camera = scene::lookAt(eye_, eye_ + forward(), up(), start_.verticalFov);
    camera.orthographic = start_.orthographic;
    camera.halfHeight = start_.halfHeight;
    return camera;
}

}  // namespace limpid::studio
