#version 460
#extension GL_EXT_scalar_block_layout : require
// Looks up textures.
#include "shaders/material/texture.glsl"

layout(local_size_x = 64) in;

struct Query {
    vec2 uv;
    float lod;
    uint ref;
};

layout(set = 0, binding = 20, scalar) uniform Params {
    uint count;
} params;
layout(set = 0, binding = 21, scalar) readonly buffer Queries {
    Query values[];
} queries;
layout(set = 0, binding = 22, scalar) writeonly buffer Results {
    vec4 values[];
} results;

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    const Query query = queries.values[i];
    const TextureRef ref = loadTextureRef(query.ref);
    results.values[i] = sampleTexture(ref, query.uv, query.lod + 0.5 * log2(float(ref.width) * float(ref.height)));
}
