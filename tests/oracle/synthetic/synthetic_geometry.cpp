#include "tests/oracle/synthetic/synthetic_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/oracle/synthetic/synthetic_frames.h"

namespace limpid::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Shape {
    dvec3 centre;  ///< at rest
    dvec3 half;    ///< half extents of a box; the radius of a sphere in all components
    bool sphere;
};

/// Indexed by instance.
const std::array<Shape, 5> shapes{{
    {{0.0, -0.5, -4.0}, {8.0, 0.5, 9.0}, false},
    {{0.0, 1.2, -12.5}, {5.0, 1.2, 0.5}, false},
    {{1.5, 0.7, -5.0}, {0.7, 0.7, 0.7}, true},
    {{0.0, 0.0, 0.0}, {0.5, 0.5, 0.35}, false},
    {{1.8, 2.0, -6.0}, {0.3, 0.3, 0.3}, true},
}};

/// Returns the distance along the unit direction, or infinity; the origin is relative to the centre.
double meetSphere(const dvec3& origin, const dvec3& direction, double radius) {
    const double b = glm::dot(origin, direction);
    const double root = b * b - glm::dot(origin, origin) + radius * radius;
    const double distance = root < 0.0 ? infinity : -b - std::sqrt(root);
    return distance > 0.0 ? distance : infinity;
}

/// Slab test: the last of the three pairs of planes that the ray enters is the face that it hits.
double meetBox(const dvec3& origin, const dvec3& direction, const dvec3& half, dvec3& normal) {
    const dvec3 a = (-half - origin) / direction, b = (half - origin) / direction;
    const dvec3 enter = glm::min(a, b), leave = glm::max(a, b);
    const int axis = enter.x > enter.y ? (enter.x > enter.z ? 0 : 2) : (enter.y > enter.z ? 1 : 2);
    if (enter[axis] <= 0.0 || enter[axis] > std::min({leave.x, leave.y, leave.z})) return infinity;
    normal = dvec3(0.0);
    normal[axis] = direction[axis] > 0.0 ? -1.0 : 1.0;
    return enter[axis];
}

}  // namespace

dmat3 SyntheticPose::rotation() const {
    const double c = std::cos(angle), s = std::sin(angle);
    return {dvec3(c, 0.0, -s), dvec3(0.0, 1.0, 0.0), dvec3(s, 0.0, c)};
}

SyntheticPose syntheticPose(uint32_t instance, int number, bool objectMoves) {
    if (instance != SyntheticScene::Box) return {};
    const double time = objectMoves ? number : 0.0;
    return {0.3 + 0.04 * time, {0.2 + 0.9 * std::sin(0.15 * time), 0.5, -2.8}};
}

SyntheticHit intersectSynthetic(const SyntheticRay& ray, int number, bool objectMoves) {
    SyntheticHit nearest;
    for (uint32_t i = 0; i < shapes.size(); ++i) {
        const Shape& shape = shapes[i];
        const SyntheticPose pose = syntheticPose(i, number, objectMoves);
        const dvec3 origin = pose.toRest(ray.origin) - shape.centre;
        const dvec3 direction = glm::transpose(pose.rotation()) * ray.direction;
        dvec3 normal(0.0);
        const double distance = shape.sphere ? meetSphere(origin, direction, shape.half.x)
                                             : meetBox(origin, direction, shape.half, normal);
        if (distance >= nearest.distance) continue;
        const dvec3 local = origin + distance * direction;
        nearest = {distance, i, shape.centre + local, shape.sphere ? local / shape.half.x : normal};
    }
    return nearest;
}

CameraParams syntheticCamera(int number, bool moves, bool orthographic, double scale, uint32_t width,
                             uint32_t height) {
    const double time = moves ? number : 0.0, yaw = 0.12 + 0.003 * time, pitch = -0.1;
    const dvec3 eye(0.03 * time, orthographic ? 1.3 : 0.6, 1.0 - 0.02 * time);
    const dvec3 forward(std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch));
    const dvec3 right(std::cos(yaw), 0.0, std::sin(yaw));
    // The tangent of half the field of view, or half the visible height; the view stays above the floor.
    const double halfHeight = orthographic ? 1.1 * scale : 0.45;
    CameraParams camera{};
    camera.origin = vec3(scale * eye);
    camera.orthographic = orthographic ? 1u : 0u;
    camera.forward = vec3(forward);
    camera.right = vec3(halfHeight * width / height * right);
    camera.up = vec3(halfHeight * glm::cross(right, forward));
    camera.spread = static_cast<float>(2.0 * halfHeight / height);
    return camera;
}

SyntheticView::SyntheticView(const CameraParams& camera, double scale, uint32_t width, uint32_t height)
    : eye_(dvec3(camera.origin) / scale),
      axes_(dvec3(camera.right), dvec3(camera.up), dvec3(camera.forward)),
      orthographic_(camera.orthographic != 0),
      size_(width, height) {
    if (!orthographic_) return;
    axes_[0] /= scale;
    axes_[1] /= scale;
}

SyntheticRay SyntheticView::centreRay(uint32_t x, uint32_t y) const {
    const dvec2 screen = (dvec2(x, y) + 0.5) / size_ * dvec2(2.0, -2.0) + dvec2(-1.0, 1.0);
    const dvec3 across = screen.x * axes_[0] + screen.y * axes_[1];
    if (orthographic_) return {eye_ + across, glm::normalize(axes_[2])};
    return {eye_, glm::normalize(axes_[2] + across)};
}

dvec2 SyntheticView::toPixel(const dvec2& screen) const {
    return (screen * dvec2(0.5, -0.5) + 0.5) * size_;
}

std::optional<SyntheticView::Projection> SyntheticView::project(const dvec3& point) const {
    const dvec3 relative = point - eye_, along = glm::inverse(axes_) * relative;
    if (along.z <= 0.0) return std::nullopt;
    if (orthographic_) return Projection{toPixel(dvec2(along)), along.z * glm::length(axes_[2])};
    return Projection{toPixel(dvec2(along) / along.z), glm::length(relative)};
}

std::optional<SyntheticView::Projection> SyntheticView::projectDirection(const dvec3& direction) const {
    const dvec3 along = glm::inverse(axes_) * direction;
    if (orthographic_ || along.z <= 0.0) return std::nullopt;
    return Projection{toPixel(dvec2(along) / along.z), 0.0};
}

}  // namespace limpid::test
