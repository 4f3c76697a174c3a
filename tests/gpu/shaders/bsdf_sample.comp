#version 460
#extension GL_EXT_scalar_block_layout : require
// Samples the BSDF perThread times in a row from one stream.
#include "bsdf_test.glsl"

struct Sampled {
    vec3 direction;
    vec3 diffuse, specular;
    float pdf;
    uint delta, valid;
};

layout(set = 0, binding = 21, scalar) writeonly buffer Results {
    Sampled samples[];
} results;

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i * params.perThread >= params.count) return;
    const Bsdf bsdf = testBsdf();
    uint rng = startStream(i, 0u, params.seed);
    for (uint n = 0u; n < params.perThread; ++n) {
        const BsdfSample s = sampleBsdf(bsdf, rng);
        results.samples[i * params.perThread + n] = Sampled(s.direction, s.value.diffuse, s.value.specular, s.value.pdf,
                                                            s.delta ? 1u : 0u, s.valid ? 1u : 0u);
    }
}
