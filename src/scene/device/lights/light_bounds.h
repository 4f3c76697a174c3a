// What a light, or a group of lights, can send where: position, directions and strength. A leaf or node of
// the light tree (light_tree.h).
//
// After A. Conty Estevez, C. Kulla, "Importance sampling of many lights with adaptive tree splitting", HPG
// 2018, and M. Pharr, W. Jakob, G. Humphreys, "Physically Based Rendering", 4th edition, section 12.6.3, with
// two changes. The strength is the luminous intensity in the brightest direction, so that a lamp and a
// triangle with the same effect have the same weight. And towards its edge the emission falls to 0, as a spot
// light's does, rather than being cut.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "base/math.h"
#include "scene/model/scene.h"

namespace limpid::scene {

struct LightBounds {
    vec3 center{0.0f};
    float radius = 0.0f;          ///< of a sphere that contains all emitting points
    vec3 axis{0.0f, 0.0f, 1.0f};  ///< unit: of the cone that contains all directions of full emission
    float spread = 0.0f;          ///< half angle of that cone, radians; pi: all directions (theta_o)
    float falloff = 0.0f;         ///< angle over which emission falls to 0 beyond the cone, radians (theta_e)
    float intensity = 0.0f;       ///< strength in the brightest direction, finite; 0: never sampled
    float range = std::numeric_limits<float>::infinity();  ///< beyond this distance there is no light
    bool twoSided = false;                                 ///< emits in the opposite directions, too
    bool spot = false;                                     ///< one spot light, whose ramp is exact
    bool inTree = true;                                    ///< false for directional lights
};

/// `radiance`: mean strength over the triangle, towards the side from which v0, v1, v2 are
/// counter-clockwise.
LightBounds triangleLightBounds(const std::array<vec3, 3>& v, double radiance, bool twoSided);
/// A point or spot light. Directional lights have no bounds.
LightBounds punctualLightBounds(const PunctualLight& light);
/// Returns bounds that contain both. Lights without intensity are ignored.
LightBounds unite(const LightBounds& a, const LightBounds& b);

/// By how much a colour counts: the root mean square of its components. Weights proportional to it minimise
/// the summed variance of the three components, while luminance would neglect blue lamps.
inline double strengthOf(const vec3& color) {
    return std::sqrt(glm::dot(glm::dvec3(color), glm::dvec3(color)) / 3.0);
}

}  // namespace limpid::scene
