#version 460
#extension GL_EXT_scalar_block_layout : require
// Temporal accumulation of visibility: docs/denoising.md, Visibility, step 2.
#include "denoise/methods/visibility/visibility_params.h"
#include "denoise/stages/guides.glsl"
#include "denoise/stages/surfaces/surface_texel.glsl"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    VisibilityAccumulateParams params;
};

#include "denoise/methods/visibility/shaders/visibility_sample.glsl"

READ_LAYER(3, motion);
READ_LAYER(4, previousNormal);
READ_UINT2(5, surfaces);
READ_UINT2(6, surfacesBefore);
layout(set = 0, binding = 7, rgba16f) uniform readonly image2D momentsBefore;
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D moments;  // svgf_moments.glsl
WRITE_UINT1(9, signal);                                                   // visibility_texel.glsl

struct Past {
    vec4 moments;
};

const Past NO_PAST = Past(vec4(0.0));

bool comparesInstances() {
    return true;
}

Past loadFirst(ivec2 at) {
    return Past(unpackedMoments(imageLoad(momentsBefore, at)));
}

float framesOf(Past past) {
    return past.moments.w;
}

void loadRest(inout Past there, ivec2 at) {}

void addPast(inout Past sum, Past tap, float weight) {
    sum.moments += weight * tap.moments;
}

Past dividedBy(Past sum, float weight) {
    return Past(sum.moments / weight);
}

bool weighsNormals() {
    return false;
}

float normalScaleOf(uvec2 surface) {
    return 0.0;
}

#include "denoise/stages/reproject/history.glsl"

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    const float x = visibilityAt(at);
    const uvec2 surface = LOAD_UINT2(surfaces, at);
    if (distanceOf(surface) <= 0.0) {
        imageStore(moments, at, vec4(0.0));
        STORE_UINT1(signal, at, packedSignal(vec2(x < 0.0 ? 1.0 : x, NOTHING_SEEN)));
        return;
    }
    vec4 now = pastOf(at, surface, motionAt(at, surface)).moments;
    const float frames = min(now.w + 1.0, params.longest);
    if (x >= 0.0) now = withSample(now, x, sharesOf(frames), frames);
    const vec4 packed = packedMoments(now);
    imageStore(moments, at, packed);
    STORE_UINT1(signal, at, packedSignal(signalOf(unpackedMoments(packed))));
}
