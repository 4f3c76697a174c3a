// Chooses a light for a point by walking the light tree (scene/device/lights/light_tree.h), and returns the probability of
// that choice.
#ifndef LIMPID_LIGHT_TREE_GLSL
#define LIMPID_LIGHT_TREE_GLSL

#include "shaders/common/rng.glsl"
#include "shaders/common/sampling.glsl"
#include "shaders/common/scene_data.glsl"
#include "shaders/material/light_distances.glsl"

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

/// The weight of a child: an upper bound of the irradiance that it can cause, except that distances are
/// those of its centre. 0 only if no light of it can reach the point. Formula: scene/device/lights/light_bounds.h.
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

uint linkedIndex(uint link) {
    return link & LIGHT_LINK_INDEX;
}

/// The weights of a child, if chosen by weight and uniformly.
struct ChildWeights {
    float weight, uniformWeight;
};

/// lightWeight(), and 1; or little of both for a lamp that is hidden by its distance map. Only single lamps have maps:
/// an inner node does not know that all its lamps are hidden.
ChildWeights childWeights(Receiver from, uvec4 place, uvec4 effect, uint firstPunctual) {
    ChildWeights child = ChildWeights(lightWeight(from, place, effect), 1.0);
    if (HAS_LIGHT_DISTANCES) {
        const uint map = linkedIndex(effect.w) - firstPunctual;  // wraps for triangles
        if ((effect.w & LIGHT_LINK_LEAF) != 0u && map < LIGHT_MAPS && child.weight > 0.0) {
            const vec3 way = uintBitsToFloat(place.xyz) - from.position;
            const float distance = length(way);
            const Hidden hidden = hiddenByMap(map, way / max(distance, 1e-37), distance);
            child.weight = max(child.weight * weightFactor(hidden), 1e-37);
            if (hidden.surely) child.uniformWeight = HIDDEN_UNIFORM_WEIGHT;
        }
    }
    return child;
}

/// At the root, a share of the choices is uniform among the children that reach the point, whatever their weights,
/// since the brightest may be hidden. It falls with their number. Distance maps leave few that are not surely hidden,
/// but near a wall's edge these may be very bright ones behind it.
float uniformShare(float reaching, bool root) {
    const float count = max(reaching, 1.0), share = 0.8 / count;
    if (!root) return 0.0;
    return HAS_LIGHT_DISTANCES ? min(max(share, 15.0 / (count * count)), 0.42) : min(share, 0.2);
}

/// A child is taken with the probability chances.byWeight * weight + chances.uniformly * uniformWeight.
struct Chances {
    float byWeight, uniformly;
};

/// `sums`: of the weights and the uniform weights of all children of a node.
Chances chancesOf(vec2 sums, bool root) {
    const float uniformly = uniformShare(sums.y, root);
    return Chances((1.0 - uniformly) / max(sums.x, 1e-37), root ? uniformly / max(sums.y, 1e-37) : 0.0);
}

/// The weights of up to LIGHT_NODE_WIDTH consecutive children of a node; 0 for what is absent or does not reach the
/// point.
struct ChildGroup {
    vec4 weights, uniformWeights;
};
const ChildGroup NO_CHILDREN = ChildGroup(vec4(0.0), vec4(0.0));

void setChild(inout ChildGroup group, uint i, ChildWeights child) {
    // Not by an index, for which GPUs would keep the group in memory.
    const bvec4 isThis = equal(uvec4(0u, 1u, 2u, 3u), uvec4(i));
    group.weights = mix(group.weights, vec4(child.weight), isThis);
    group.uniformWeights = mix(group.uniformWeights, vec4(child.weight > 0.0 ? child.uniformWeight : 0.0), isThis);
}

vec2 sumsOf(ChildGroup group) {
    return vec2(dot(group.weights, vec4(1.0)), dot(group.uniformWeights, vec4(1.0)));
}

/// A light of the tree, the probability of choosing it, and the irradiance that all lights of the tree might cause;
/// both 0: none can reach the point.
struct ChosenLight {
    uint light;
    float probability, irradiance;
};

/// Of the root, where point and spot lights may be more children than a group has.
struct RootGroups {
    vec2 sums[LIGHT_ROOT_CHILDREN / LIGHT_NODE_WIDTH];
    uint count;
};

/// Takes one of the groups. What is left of `u` is again uniform.
uint takeGroup(RootGroups groups, Chances chances, inout float u) {
    uint taken = 0u;
    float start = 0.0, chance = 1.0, end = 0.0;  // of the interval of the group
    for (uint i = 0u; i < groups.count && u >= end; ++i) {
        const float width = dot(vec2(chances.byWeight, chances.uniformly), groups.sums[i]);
        if (width <= 0.0) continue;
        taken = i;
        chance = width;
        start = end;
        end += width;
    }
    u = clamp((u - start) / chance, 0.0, 1.0 - 1.0 / float(0x01000000));
    return taken;
}

/// Of a group of the root that is taken, once more.
ChildGroup loadRootGroup(Receiver from, uint first, uint firstPunctual) {
    ChildGroup group = NO_CHILDREN;
    for (uint i = 0u; i < LIGHT_NODE_WIDTH; ++i) {
        const int at = int((first + i) * LIGHT_CHILD_TEXELS);
        const uvec4 effect = imageLoad(lightTree, at + 1);
        setChild(group, i, childWeights(from, imageLoad(lightTree, at), effect, firstPunctual));
        if ((effect.w & LIGHT_LINK_LAST) != 0u) break;
    }
    return group;
}

/// Takes a child of the group that begins with `first`, and returns its link. Multiplies the probability by that of the
/// choice. What is left of `u` is again uniform.
uint takeChild(ChildGroup group, uint first, Chances chances, inout float u, inout float probability, inout uint rng) {
    const vec4 parts = chances.byWeight * group.weights + chances.uniformly * group.uniformWeights;
    const uint taken = takeOfFour(parts, u);
    const vec2 pair = taken > 1u ? parts.zw : parts.xy;
    const float part = (taken & 1u) != 0u ? pair.y : pair.x;
    probability *= part;
    u = placeWithin(u, 1.0 / part, rng);
    return imageLoad(lightTree, int((first + taken) * LIGHT_CHILD_TEXELS) + 1).w;
}

/// Goes from the root to a light. `firstPunctual`: the index of the first punctual light. If a node turns out to have
/// no child that reaches the point, the walk ends without a light. `u` chooses; what is left of it, its place in the
/// light's interval, is again uniform.
ChosenLight chooseFromLightTree(Receiver from, uint firstPunctual, inout float u, inout uint rng) {
    ChosenLight chosen = ChosenLight(0u, 1.0, -1.0);
    ChildGroup group = NO_CHILDREN;
    RootGroups groups;
    groups.count = 0u;
    vec2 sums = vec2(0.0);
    uint first = 0u, child = 0u;
    // One loop over the children of all nodes: a loop in a loop takes longer where neighbours walk different ways.
    while (true) {
        const uvec4 place = imageLoad(lightTree, int(child * LIGHT_CHILD_TEXELS));
        const uvec4 effect = imageLoad(lightTree, int(child * LIGHT_CHILD_TEXELS) + 1);
        setChild(group, child - first, childWeights(from, place, effect, firstPunctual));
        ++child;
        const bool isLast = (effect.w & LIGHT_LINK_LAST) != 0u;
        if (!isLast && (!HAS_PUNCTUAL_LIGHTS || child - first < LIGHT_NODE_WIDTH)) continue;
        const bool root = chosen.irradiance < 0.0;
        const vec2 sumsOfGroup = sumsOf(group);
        sums += sumsOfGroup;
        if (HAS_PUNCTUAL_LIGHTS && root) {
            groups.sums[groups.count] = sumsOfGroup;
            ++groups.count;
            if (!isLast) {
                first = child;
                group = NO_CHILDREN;
                continue;
            }
        }
        const Chances chances = chancesOf(sums, root);
        if (root) chosen.irradiance = sums.x;
        if (!(sums.x > 0.0)) {
            chosen.probability = 0.0;
            break;
        }
        if (HAS_PUNCTUAL_LIGHTS) {
            if (root && groups.count > 1u) {
                first = takeGroup(groups, chances, u) * LIGHT_NODE_WIDTH;
                group = loadRootGroup(from, first, firstPunctual);
            }
        }
        const uint link = takeChild(group, first, chances, u, chosen.probability, rng);
        first = child = linkedIndex(link);
        if ((link & LIGHT_LINK_LEAF) != 0u) break;
        group = NO_CHILDREN;
        sums = vec2(0.0);
    }
    chosen.light = child;
    return chosen;
}

/// Returns the probability with which chooseFromLightTree() chooses the light at the end of `trail`.
float lightTreeProbability(Receiver from, uint firstPunctual, uvec4 trail) {
    vec2 sums = vec2(0.0);
    ChildWeights taken = ChildWeights(0.0, 0.0);
    float probability = 1.0;
    uint first = 0u, child = 0u, link = 0u, bits = LIGHT_TRAIL_ROOT_BITS;
    while (true) {
        const uvec4 place = imageLoad(lightTree, int(child * LIGHT_CHILD_TEXELS));
        const uvec4 effect = imageLoad(lightTree, int(child * LIGHT_CHILD_TEXELS) + 1);
        const ChildWeights it = childWeights(from, place, effect, firstPunctual);
        sums += vec2(it.weight, it.weight > 0.0 ? it.uniformWeight : 0.0);
        if (child - first == (trail.x & ((1u << bits) - 1u))) {
            taken = it;
            link = effect.w;
        }
        ++child;
        if ((effect.w & LIGHT_LINK_LAST) == 0u) continue;
        const Chances chances = chancesOf(sums, bits == LIGHT_TRAIL_ROOT_BITS);
        if (!(taken.weight > 0.0)) return 0.0;
        probability *= chances.byWeight * taken.weight + chances.uniformly * taken.uniformWeight;
        if ((link & LIGHT_LINK_LEAF) != 0u) return probability;
        first = child = linkedIndex(link);
        sums = vec2(0.0);
        trail = (trail >> bits) | (uvec4(trail.yzw, 0u) << (32u - bits));
        bits = LIGHT_TRAIL_BITS;
    }
}

#endif
