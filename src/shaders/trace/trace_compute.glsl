// Ray traversal of the four-wide trees described in scene/device/trees/bvh.h.
//
// CPUs use two nested loops ("while-while": T. Aila, S. Laine, "Understanding the efficiency of ray traversal
// on GPUs", HPG 2009): first all lanes descend to a leaf, then all test triangles. GPUs use one loop in which
// each lane takes its own step, a node or a triangle ("if-if" there). The triangle test is watertight: S.
// Woop, C. Benthin, I. Wald, "Watertight ray/triangle intersection", JCGT 2013, but with two vectors across
// the ray instead of their shear; a vertex projects to the same point for all its triangles.
#ifndef LIMPID_TRACE_COMPUTE_GLSL
#define LIMPID_TRACE_COMPUTE_GLSL

#include "shaders/trace/bvh_node.glsl"

const uint REF_LEAF = 0x80000000u;
const uint REF_INDEX = 0x0fffffffu;
const uint REF_COUNT_SHIFT = 28u;
const uint REF_DONE = 0xffffffffu;           // an unreachable leaf: traversal ends
const uint REF_LEAVE_INSTANCE = 0xfffffffeu;  // back to world space

/// Sorts in ascending order with a network of five comparisons.
uvec4 sortKeys(uvec4 k) {
    k = uvec4(min(k.xy, k.zw), max(k.xy, k.zw));
    k = uvec4(min(k.x, k.y), max(k.x, k.y), min(k.z, k.w), max(k.z, k.w));
    return uvec4(k.x, min(k.y, k.z), max(k.y, k.z), k.w);
}

/// Projects a point relative to the ray's origin across the ray. `precise`, so that it is the same for every
/// triangle.
vec2 across(TraversalRay ray, vec3 p) {
    precise const float x = fma(p.x, ray.acrossX.x, fma(p.y, ray.acrossX.y, p.z * ray.acrossX.z));
    precise const float y = fma(p.x, ray.acrossY.x, fma(p.y, ray.acrossY.y, p.z * ray.acrossY.z));
    return vec2(x, y);
}

/// Replaces `hit` if the triangle is hit at a smaller distance.
void intersectTriangle(uint index, TraversalRay ray, uint instance, inout Hit hit, uint rng) {
    const int at = int(index * BVH_TRIANGLE_TEXELS);
    const vec4 texel0 = imageLoad(bvhTriangles, at);
    const vec3 v0 = texel0.xyz - ray.origin;
    const vec3 v1 = imageLoad(bvhTriangles, at + 1).xyz - ray.origin;
    const vec3 v2 = imageLoad(bvhTriangles, at + 2).xyz - ray.origin;
    const vec2 a = across(ray, v0), b = across(ray, v1), c = across(ray, v2);
    // Each difference has the correct sign or is 0, which counts as inside, so there are no gaps between
    // neighbours.
    precise const float weight0 = c.x * b.y - c.y * b.x;
    precise const float weight1 = a.x * c.y - a.y * c.x;
    precise const float weight2 = b.x * a.y - b.y * a.x;
    const bool inside = min(weight0, min(weight1, weight2)) >= 0.0 || max(weight0, max(weight1, weight2)) <= 0.0;
    if (!inside) return;
    const vec3 normal = cross(v1 - v0, v2 - v0);
    const float t = dot(v0, normal) / dot(normal, ray.direction);
    const float area = weight0 + weight1 + weight2;
    const vec2 barycentrics = vec2(weight1, weight2) / area;
    // Written so that NaN, from numbers out of range, counts as a miss: the sum is NaN if a weight is.
    bool accepted = abs(area) > 0.0 && t > 0.0 && t < hit.t;
    if (HAS_ALPHA) {
        if (accepted && (floatBitsToUint(texel0.w) & BVH_TRIANGLE_ALPHA) != 0u) {
            accepted = passesAlphaTest(index, instance, barycentrics, rng);
        }
    }
    if (accepted) hit = Hit(t, barycentrics, index, instance);
}

/// With `anyHit`, traversal ends at the first hit found.
Hit traverse(Ray worldRay, uint rootNode, const bool anyHit, uint rng) {
    Hit hit = Hit(worldRay.tMax, vec2(0.0), NONE, NONE);
    TraversalRay ray = traversalRay(worldRay.origin, worldRay.direction);
    uint instance = NONE;
    bool inTopTree = TWO_LEVEL;
    uint stack[STACK_SIZE];
    stack[0] = REF_DONE;
    int top = 1;  // number of entries in use
    uint current = rootNode;
    while (true) {
        // Each device uses only one of these two loops.
        while (CPU_LOOPS && current < REF_LEAF) {
            uvec4 children;
            const uvec4 keys = sortKeys(intersectChildren(current, ray, hit.t, children));
            // Branches cost both sides here, and stores past the top are harmless.
            stack[top] = childOf(keys.w, children);
            top += keys.w != KEY_MISS ? 1 : 0;
            stack[top] = childOf(keys.z, children);
            top += keys.z != KEY_MISS ? 1 : 0;
            stack[top] = childOf(keys.y, children);
            top += keys.y != KEY_MISS ? 1 : 0;
            top -= keys.x == KEY_MISS ? 1 : 0;
            current = keys.x == KEY_MISS ? stack[top] : childOf(keys.x, children);
        }
        if (!CPU_LOOPS && current < REF_LEAF) {
            uvec4 children;
            uvec4 keys = intersectChildren(current, ray, hit.t, children);
            // The order does not matter for shadow rays, which end at any hit.
            if (!anyHit) keys = sortKeys(keys);
            if (keys.w != KEY_MISS) stack[top++] = childOf(keys.w, children);
            if (keys.z != KEY_MISS) stack[top++] = childOf(keys.z, children);
            if (keys.y != KEY_MISS) stack[top++] = childOf(keys.y, children);
            if (keys.x != KEY_MISS) stack[top++] = childOf(keys.x, children);
            current = stack[--top];
            continue;
        }
        if (current == REF_DONE) break;
        if (TWO_LEVEL && current == REF_LEAVE_INSTANCE) {
            ray = traversalRay(worldRay.origin, worldRay.direction);
            instance = NONE;
            inTopTree = true;
        } else if (TWO_LEVEL && inTopTree) {
            const int at = int((current & REF_INDEX) * BVH_INSTANCE_TEXELS);
            const vec4 row0 = uintBitsToFloat(imageLoad(bvhInstances, at));
            const vec4 row1 = uintBitsToFloat(imageLoad(bvhInstances, at + 1));
            const vec4 row2 = uintBitsToFloat(imageLoad(bvhInstances, at + 2));
            const uvec4 record = imageLoad(bvhInstances, at + 3);
            // Not normalised, so distances stay those of world space.
            const vec4 origin = vec4(worldRay.origin, 1.0), direction = vec4(worldRay.direction, 0.0);
            ray = traversalRay(vec3(dot(row0, origin), dot(row1, origin), dot(row2, origin)),
                               vec3(dot(row0, direction), dot(row1, direction), dot(row2, direction)));
            instance = record.y;
            inTopTree = false;
            stack[top++] = REF_LEAVE_INSTANCE;
            current = record.x;
            continue;
        } else {
            const uint first = current & REF_INDEX, more = (current >> REF_COUNT_SHIFT) & 7u;
            if (CPU_LOOPS) {
                for (uint index = first; index <= first + more; ++index)
                    intersectTriangle(index, ray, instance, hit, rng);
            } else {
                intersectTriangle(first, ray, instance, hit, rng);
                if (more != 0u && !(anyHit && hit.triangle != NONE)) {
                    current = REF_LEAF | (more - 1u) << REF_COUNT_SHIFT | (first + 1u);
                    continue;
                }
            }
        }
        current = stack[--top];
        if (anyHit && hit.triangle != NONE) break;
    }
    if (hit.triangle == NONE) hit.t = INFINITE_DISTANCE;
    return hit;
}

Hit traceClosest(Ray ray, uint rootNode, uint rng) {
    return traverse(ray, rootNode, false, rng);
}

bool traceAny(Ray ray, uint rootNode, uint rng) {
    return isHit(traverse(ray, rootNode, true, rng));
}

#endif
