// Chooses a light for a point by walking the light tree (scene/device/light_tree.h), and returns the probability of
// that choice.
#ifndef LIMPID_LIGHT_TREE_GLSL
#define LIMPID_LIGHT_TREE_GLSL

#include "shaders/common/rng.glsl"
#include "shaders/common/sampling.glsl"
#include "shaders/common/scene_data.glsl"

/// The point that is lit.
struct Receiver {
    vec3 position, normal, geometricNormal;
    bool bothSides;  // light may also arrive from behind the surface
    float grazing;   // minimum weight of a light in front of the surface, for materials where the cosine does
                     // not matter
};

/// Cosine of max(a - b, 0), for angles from 0 to pi.
float cosineOfDifference(float cosineA, float cosineB) {
    const float sines = sqrt(max(1.0 - cosineA * cosineA, 0.0) * max(1.0 - cosineB * cosineB, 0.0));
    return cosineA > cosineB ? 1.0 : cosineA * cosineB + sines;
}

/// The packed angle is sin(angle / 2).
float cosineOfPacked(float sine) {
    return 1.0 - 2.0 * sine * sine;
}

/// Share of the strongest emission that may leave in a direction, at `cosineW` from the axis, from any point of a
/// sphere of angular radius `cosineB`.
float emittedShare(float cosineW, float cosineB, vec2 angles, uint link) {
    const float spread = cosineOfPacked(angles.x), edge = cosineOfPacked(angles.y);
    const float within = cosineOfDifference(cosineOfDifference(cosineW, spread), cosineB);
    float share = (within - edge) / max(1.0 - edge, 1e-7);
    if (HAS_PUNCTUAL_LIGHTS) {
        // The ramp of punctualAttenuation().
        const float ramp = min((cosineW - edge) / max(0.001, spread - edge), 1.0);
        if ((link & LIGHT_LINK_SPOT) != 0u) share = ramp > 0.0 ? ramp * ramp : 0.0;
    }
    return min(share, 1.0);
}

/// Returns the largest usable share of light from a sphere of angular radius `cosineB`, seen at `cosine` from the
/// surface's normal.
float usableShare(Receiver from, float cosine, float cosineB) {
    const float nearest = cosineOfDifference(from.bothSides ? abs(cosine) : cosine, cosineB);
    // Rounding must not remove a light at the horizon.
    const float usable = max(nearest + 1e-4, from.bothSides ? 0.01 : from.grazing);
    return max(usable, 0.0);
}

/// The weight of a child of a node: an upper bound of the irradiance that it can cause, except that distances are
/// those of its centre. 0 only if no light of it can reach the point. Formula: scene/device/light_bounds.h.
float lightWeight(Receiver from, uvec4 place, uvec4 effect) {
    const float intensity = uintBitsToFloat(effect.z);
    const float radius = uintBitsToFloat(place.w & 0xFFFF0000u), range = uintBitsToFloat(place.w << 16);
    const vec3 way = uintBitsToFloat(place.xyz) - from.position;
    const float distance2 = dot(way, way), radius2 = radius * radius;
    const float inverse = inversesqrt(max(distance2, 1e-37));
    const vec3 direction = way * inverse;
    const float cosineB = distance2 > radius2 ? sqrt(max(1.0 - radius2 * inverse * inverse, 0.0)) : -1.0;
    float cosineW = -dot(decodeOctahedral(effect.x), direction);
    if ((effect.w & LIGHT_LINK_TWO_SIDED) != 0u) cosineW = abs(cosineW);
    float share = emittedShare(cosineW, cosineB, unpackUnorm2x16(effect.y), effect.w) *
                  usableShare(from, dot(from.normal, direction), cosineB);
    if (HAS_PUNCTUAL_LIGHTS) {
        const float ratio = max(distance2 * inverse - radius, 0.0) / range;
        const float r2 = ratio * ratio;
        share *= max(1.0 - r2 * r2, 0.0);
    }
    const float weight = intensity * share / max(max(distance2, radius2), 1e-37);
    return intensity > 0.0 && share > 0.0 ? clamp(weight, 1e-30, 1e30) : 0.0;
}

/// A node's children: their weights, and what they are.
struct LightNode {
    vec4 weights;
    uvec4 links;
};

LightNode weighLightNode(Receiver from, uint node) {
    LightNode result;
    for (int i = 0; i < 4; ++i) {
        const int at = int(node * LIGHT_NODE_TEXELS) + 2 * i;
        const uvec4 place = imageLoad(lightTree, at), effect = imageLoad(lightTree, at + 1);
        result.weights[i] = lightWeight(from, place, effect);
        result.links[i] = effect.w;
    }
    return result;
}

float sumOf(vec4 v) {
    return v.x + v.y + v.z + v.w;
}

/// A child's probability.
float shareOfChild(vec4 weights, uint child) {
    return weights[child] / max(sumOf(weights), 1e-30);
}

uint linkedIndex(uint link) {
    return link & LIGHT_LINK_INDEX;
}

/// A light of the tree, the probability of choosing it, and the irradiance that all lights of the tree might cause;
/// both 0: none can reach the point.
struct ChosenLight {
    uint light;
    float probability, irradiance;
};

ChosenLight chooseFromLightTree(Receiver from, inout uint rng) {
    ChosenLight chosen = ChosenLight(0u, 1.0, -1.0);
    uint link = 0u;
    while ((link & LIGHT_LINK_LEAF) == 0u && chosen.probability > 0.0) {
        const LightNode node = weighLightNode(from, linkedIndex(link));
        const vec4 w = node.weights;
        if (chosen.irradiance < 0.0) chosen.irradiance = sumOf(w);
        const float x = random(rng) * sumOf(w);
        // Without `w > 0`, rounding could choose a child without weight.
        uint child = 0u;
        for (uint i = 1u; i < 4u; ++i) {
            const float before = i == 1u ? w.x : i == 2u ? w.x + w.y : w.x + w.y + w.z;
            if (w[i] > 0.0 && (x >= before || w[child] == 0.0)) child = i;
        }
        link = node.links[child];
        chosen.probability *= shareOfChild(w, child);
    }
    chosen.light = linkedIndex(link);
    return chosen;
}

/// Returns the probability with which chooseFromLightTree() chooses the light at the end of `trail`.
float lightTreeProbability(Receiver from, uvec2 trail) {
    float probability = 1.0;
    uint link = 0u;
    while ((link & LIGHT_LINK_LEAF) == 0u && probability > 0.0) {
        const LightNode node = weighLightNode(from, linkedIndex(link));
        const uint child = trail.x & 3u;
        trail = uvec2((trail.x >> 2) | (trail.y << 30), trail.y >> 2);
        link = node.links[child];
        probability *= shareOfChild(node.weights, child);
    }
    return probability;
}

#endif
