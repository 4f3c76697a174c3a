#version 460
#extension GL_EXT_scalar_block_layout : require
// Evaluates the BSDF and the sampling density for given directions.
#include "bsdf_test.glsl"

struct Evaluated {
    vec3 diffuse, specular;
    float pdf;
};

layout(set = 0, binding = 21, scalar) readonly buffer Directions {
    vec3 values[];
} directions;
layout(set = 0, binding = 22, scalar) writeonly buffer Results {
    Evaluated values[];
} results;

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    const BsdfValue value = evaluateBsdf(testBsdf(), directions.values[i]);
    results.values[i] = Evaluated(value.diffuse, value.specular, value.pdf);
}
