#version 460
#extension GL_EXT_scalar_block_layout : require
// Rounds numbers to halves, and takes them through packed texels and back.
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 64) in;

struct Rounded {
    vec4 nearest, unpacked;
};

layout(set = 0, binding = 0, scalar) uniform Params {
    uint count;
} params;
layout(set = 0, binding = 1, scalar) readonly buffer Values {
    vec4 values[];
} values;
layout(set = 0, binding = 2, scalar) writeonly buffer Results {
    Rounded values[];
} results;

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    const vec4 value = values.values[i];
    results.values[i] = Rounded(nearestHalf(value), unpackHalf4(packHalf4(value)));
}
