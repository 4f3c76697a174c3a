#version 460
#extension GL_EXT_scalar_block_layout : require
// Running means by count in float32, with variances: T. F. Chan, G. H. Golub, R. J. LeVeque, "Updating
// formulae and a pairwise algorithm for computing sample variances", 1979.
#include "passes/accumulate/accumulate_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    AccumulateParams params;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D added;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D before;
layout(set = 0, binding = 3, rgba32f) uniform writeonly image2D after;

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    vec4 mean = imageLoad(added, at);
    if (params.countBefore > 0.0) {
        const vec4 old = imageLoad(before, at);
        const float share = params.countAdded / (params.countBefore + params.countAdded);
        const vec3 delta = mean.rgb - old.rgb;
        const float along = dot(delta, params.weights);
        const float squared = params.perComponent != 0u ? dot(delta, delta) / 3.0 : along * along;
        mean = vec4(old.rgb + delta * share, mix(old.a, mean.a, share) + squared * share * (1.0 - share));
    }
    imageStore(after, at, mean);
}
