#include "scene/device/lights/light_bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limpid::scene {
namespace {

constexpr float maxIntensity = 1e30f;

float finiteIntensity(double intensity) {
    return std::isfinite(intensity) ? static_cast<float>(std::clamp(intensity, 0.0, double{maxIntensity}))
                                    : 0.0f;
}

vec3 unitOr(const vec3& v, const vec3& otherwise) {
    const double length = glm::length(glm::dvec3(v));
    return length > 0.0 ? vec3(glm::dvec3(v) / length) : otherwise;
}

/// The smallest sphere around two spheres.
void uniteSpheres(const LightBounds& a, const LightBounds& b, LightBounds& result) {
    const glm::dvec3 way = glm::dvec3(b.center) - glm::dvec3(a.center);
    const double distance = glm::length(way), ra = double{a.radius}, rb = double{b.radius};
    result.center = a.center;
    result.radius = a.radius;
    if (distance + rb <= ra) return;
    if (distance + ra <= rb) {
        result.center = b.center;
        result.radius = b.radius;
        return;
    }
    const double radius = 0.5 * (distance + ra + rb);
    result.center = vec3(glm::dvec3(a.center) + way * ((radius - ra) / distance));
    // Rounding moves the centre; the sphere must still contain both.
    const auto reach = [&](const LightBounds& part) {
        return glm::length(glm::dvec3(part.center) - glm::dvec3(result.center)) + double{part.radius};
    };
    result.radius = std::nextafter(static_cast<float>(std::max(reach(a), reach(b))), INFINITY);
}

/// The smallest cone around two cones (PBR, section 3.8.4).
void uniteCones(const LightBounds& a, const LightBounds& b, LightBounds& result) {
    constexpr double pi64 = std::numbers::pi;
    const LightBounds &wide = a.spread >= b.spread ? a : b, &narrow = a.spread >= b.spread ? b : a;
    const glm::dvec3 from(wide.axis), to(narrow.axis);
    const double between = std::atan2(glm::length(glm::cross(from, to)), glm::dot(from, to));
    const double big = double{wide.spread}, small = double{narrow.spread};
    result.axis = wide.axis;
    result.spread = wide.spread;
    if (std::min(between + small, pi64) <= big) return;
    const double spread = 0.5 * (big + between + small);
    const glm::dvec3 normal = glm::cross(from, to);
    result.spread = pi;
    if (spread >= pi64 || glm::length(normal) == 0.0) return;
    const glm::dvec3 side = glm::cross(glm::normalize(normal), from);
    const double turn = spread - big;
    result.axis = vec3(glm::normalize(std::cos(turn) * from + std::sin(turn) * side));
    result.spread = std::min(static_cast<float>(spread) + 1e-6f, pi);
}

}  // namespace

LightBounds triangleLightBounds(const std::array<vec3, 3>& v, double radiance, bool twoSided) {
    const glm::dvec3 a(v[0]), b(v[1]), c(v[2]);
    const glm::dvec3 center = (a + b + c) / 3.0, normal = glm::cross(b - a, c - a);
    LightBounds bounds;
    bounds.center = vec3(center);
    for (const vec3& corner : v) {
        const double reach = glm::length(glm::dvec3(corner) - glm::dvec3(bounds.center));
        bounds.radius = std::max(bounds.radius, std::nextafter(static_cast<float>(reach), INFINITY));
    }
    bounds.axis = unitOr(vec3(normal / std::max(glm::length(normal), 1e-300)), bounds.axis);
    bounds.falloff = pi / 2;
    bounds.intensity = finiteIntensity(0.5 * glm::length(normal) * radiance);
    bounds.twoSided = twoSided;
    return bounds;
}

LightBounds punctualLightBounds(const PunctualLight& light) {
    LightBounds bounds;
    bounds.center = light.position;
    bounds.intensity = finiteIntensity(strengthOf(light.intensity));
    if (light.range > 0.0f) bounds.range = light.range;
    bounds.spread = pi;
    bounds.falloff = pi / 2;
    if (light.kind != PunctualLight::Kind::Spot) return bounds;
    bounds.axis = unitOr(light.direction, bounds.axis);
    bounds.spread = std::clamp(light.innerCone, 0.0f, pi);
    bounds.falloff = std::clamp(light.outerCone - bounds.spread, 0.0f, pi);
    bounds.spot = true;
    return bounds;
}

LightBounds unite(const LightBounds& a, const LightBounds& b) {
    if (!(b.intensity > 0.0f)) return a;
    if (!(a.intensity > 0.0f)) return b;
    LightBounds result;
    uniteSpheres(a, b, result);
    uniteCones(a, b, result);
    result.falloff = std::max(a.falloff, b.falloff);
    result.intensity = std::min(a.intensity + b.intensity, maxIntensity);
    result.range = std::max(a.range, b.range);
    result.twoSided = a.twoSided || b.twoSided;
    return result;
}

}  // namespace limpid::scene
