#version 460
#extension GL_EXT_scalar_block_layout : require
// Finds where a surface ends or bends sharply between two pixels. docs/denoising.md, "Edges".
#include "denoise/stages/guides.glsl"
#include "denoise/stages/taa/edges_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    EdgesParams params;
};
READ_LAYER(1, depth);
READ_LAYER(2, normal);
layout(set = 0, binding = 3, r32ui) uniform writeonly uimage2D edges;

/// Of two pixels of one surface: the largest difference of their distances, relative to the smaller one, and the
/// smallest cosine between their normals.
const float DISTANCE = 0.1;
const float COSINE = 0.85;

struct Seen {
    float distance;  // 0: nothing
    vec3 normal;     // 0: unknown
};

Seen seenAt(ivec2 at) {
    return Seen(hitDistance(LOAD_LAYER(depth, at)), unitNormal(LOAD_LAYER(normal, at)));
}

bool differ(Seen a, Seen b) {
    if (a.distance == 0.0 || b.distance == 0.0) return a.distance != b.distance;
    const bool bends = a.normal != vec3(0.0) && b.normal != vec3(0.0) && dot(a.normal, b.normal) < COSINE;
    return bends || abs(a.distance - b.distance) > DISTANCE * min(a.distance, b.distance);
}

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    const Seen own = seenAt(at);
    uint bits = 0u;
    if (at.x + 1 < int(params.width) && differ(own, seenAt(at + ivec2(1, 0)))) bits |= EDGE_RIGHT;
    if (at.y + 1 < int(params.height) && differ(own, seenAt(at + ivec2(0, 1)))) bits |= EDGE_BELOW;
    imageStore(edges, at, uvec4(bits, 0u, 0u, 0u));
}
