#version 460
#extension GL_EXT_scalar_block_layout : require
// Returns radiance and density of the environment in given directions.
#include "lights_test.glsl"

layout(set = 0, binding = 21, scalar) readonly buffer Directions {
    vec3 values[];
} directions;
layout(set = 0, binding = 22, scalar) writeonly buffer Results {
    vec4 values[];
} results;

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    const vec2 uv = latLongOf(directions.values[i]);
    results.values[i] = vec4(environmentRadiance(uv, params.scene), environmentPdf(uv, params.scene));
}
