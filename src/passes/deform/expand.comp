#version 460
#extension GL_EXT_scalar_block_layout : require
// Converts nodes from the quantised format to the expanded one, like scene/prepare/expanded_nodes.cpp does when
// a scene is loaded.
#include "passes/deform/deform_params.h"
#include "shaders/common/scene_layout.h"

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    ExpandParams params;
};
layout(set = 0, binding = 1, rgba32ui) uniform readonly uimageBuffer quantisedNodes;
layout(set = 0, binding = 2, rgba32ui) uniform writeonly uimageBuffer bvhNodes;

vec4 bytesOf(uint word) {
    return vec4(float(word & 255u), float((word >> 8) & 255u), float((word >> 16) & 255u), float(word >> 24));
}

void main() {
    if (gl_GlobalInvocationID.x >= params.count) return;
    const uint node = params.first + gl_GlobalInvocationID.x;
    const int at = int(node * BVH_NODE_TEXELS), to = int(node * EXPANDED_NODE_TEXELS);
    const uvec4 head = imageLoad(quantisedNodes, at);
    const uvec4 a = imageLoad(quantisedNodes, at + 1), b = imageLoad(quantisedNodes, at + 2);
    const uint lower[3] = uint[3](a.x, a.y, a.z), upper[3] = uint[3](a.w, b.x, b.y);
    for (int axis = 0; axis < 3; ++axis) {
        const float origin = uintBitsToFloat(head[axis]);
        const float cell = uintBitsToFloat(((head.w >> (8 * axis)) & 255u) << 23);
        const vec4 low = bytesOf(lower[axis]), high = bytesOf(upper[axis]);
        const bvec4 absent = greaterThan(low, high);
        imageStore(bvhNodes, to + axis, floatBitsToUint(mix(origin + cell * low, vec4(1e30), absent)));
        imageStore(bvhNodes, to + 3 + axis, floatBitsToUint(mix(origin + cell * high, vec4(-1e30), absent)));
    }
    imageStore(bvhNodes, to + 6, imageLoad(quantisedNodes, at + 3));
}
