#version 460
#extension GL_EXT_scalar_block_layout : require
// Refits the nodes of one level of the deforming trees to their moved triangles; the topology stays the same.
// Must match makeBvhNode() in scene/bvh.cpp.
#include "passes/deform/deform_params.h"
#include "shaders/common/scene_layout.h"

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    RefitParams params;
};
layout(set = 0, binding = 1, r32ui) uniform readonly uimageBuffer refitNodes;
layout(set = 0, binding = 2, rgba32f) uniform imageBuffer nodeBounds;
layout(set = 0, binding = 3, rgba32ui) uniform uimageBuffer quantisedNodes;
layout(set = 0, binding = 4, rgba32f) uniform imageBuffer bvhTriangles;
layout(set = 0, binding = 5, rgba32ui) uniform readonly uimageBuffer triangles;
layout(set = 0, binding = 6, rgba32f) uniform readonly imageBuffer posedVertices;

const uint REF_LEAF = 0x80000000u;

struct Box {
    vec3 lower, upper;
};

void grow(inout Box box, vec3 p) {
    box.lower = min(box.lower, p);
    box.upper = max(box.upper, p);
}

/// Moves the leaf's triangles to their current vertices.
Box refitLeaf(uint ref) {
    Box box = Box(vec3(3e38), vec3(-3e38));
    const uint first = ref & 0x0fffffffu;
    const uint end = first + ((ref >> 28) & 7u) + 1u;
    for (uint i = first; i < end; ++i) {
        const int at = int(i * BVH_TRIANGLE_TEXELS);
        const uint shading = floatBitsToUint(imageLoad(bvhTriangles, at + 2).w);
        const uvec3 corners = imageLoad(triangles, int(shading)).xyz;
        for (int k = 0; k < 3; ++k) {
            const vec3 p = imageLoad(posedVertices, int(corners[k])).xyz;
            imageStore(bvhTriangles, at + k, vec4(p, imageLoad(bvhTriangles, at + k).w));
            grow(box, p);
        }
    }
    return box;
}

Box childBox(uint ref) {
    if ((ref & REF_LEAF) != 0u) return refitLeaf(ref);
    const int at = int((ref - params.firstNode) * NODE_BOUNDS_TEXELS);
    return Box(imageLoad(nodeBounds, at).xyz, imageLoad(nodeBounds, at + 1).xyz);
}

/// Returns the smallest power of two (as a biased exponent) of which 255 cells reach from `low` to `high`.
uint gridExponent(float low, float high) {
    uint exponent = clamp(floatBitsToUint(max(high - low, 0.0) / 255.0) >> 23, 1u, 254u);
    for (int i = 0; i < 3; ++i) {
        if (exponent < 254u && low + 255.0 * uintBitsToFloat(exponent << 23) < high) ++exponent;
    }
    return exponent;
}

uint cellBelow(float value, float origin, float cell) {
    float low = clamp(floor((value - origin) / cell), 0.0, 255.0);
    if (low > 0.0 && origin + low * cell > value) low -= 1.0;
    return uint(low);
}

uint cellAbove(float value, float origin, float cell) {
    float high = clamp(ceil((value - origin) / cell), 0.0, 255.0);
    if (high < 255.0 && origin + high * cell < value) high += 1.0;
    return uint(high);
}

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    const uint node = imageLoad(refitNodes, int(params.first + i)).x;
    const int at = int(node * BVH_NODE_TEXELS);
    const uvec4 children = imageLoad(quantisedNodes, at + 3);
    // A missing child repeats the first one's reference.
    Box boxes[4];
    Box all = Box(vec3(3e38), vec3(-3e38));
    for (int c = 0; c < 4; ++c) {
        if (c > 0 && children[c] == children[0]) continue;
        boxes[c] = childBox(children[c]);
        grow(all, boxes[c].lower);
        grow(all, boxes[c].upper);
    }
    const uvec3 exponents =
        uvec3(gridExponent(all.lower.x, all.upper.x), gridExponent(all.lower.y, all.upper.y), gridExponent(all.lower.z, all.upper.z));
    uvec3 lower = uvec3(0u), upper = uvec3(0u);  // one byte per child
    for (int c = 0; c < 4; ++c) {
        const bool absent = c > 0 && children[c] == children[0];
        for (int axis = 0; axis < 3; ++axis) {
            const float cell = uintBitsToFloat(exponents[axis] << 23), origin = all.lower[axis];
            const uint low = absent ? 255u : cellBelow(boxes[c].lower[axis], origin, cell);
            const uint high = absent ? 0u : cellAbove(boxes[c].upper[axis], origin, cell);
            lower[axis] |= low << (8 * c);
            upper[axis] |= high << (8 * c);
        }
    }
    imageStore(quantisedNodes, at, uvec4(floatBitsToUint(all.lower), exponents.x | exponents.y << 8 | exponents.z << 16));
    imageStore(quantisedNodes, at + 1, uvec4(lower, upper.x));
    imageStore(quantisedNodes, at + 2, uvec4(upper.yz, 0u, 0u));
    const int bounds = int((node - params.firstNode) * NODE_BOUNDS_TEXELS);
    imageStore(nodeBounds, bounds, vec4(all.lower, 0.0));
    imageStore(nodeBounds, bounds + 1, vec4(all.upper, 0.0));
}
