#version 460
#extension GL_EXT_scalar_block_layout : require
// Shortens the history where visibility has changed: docs/denoising.md, Visibility, step 3.
#include "denoise/methods/visibility/visibility_params.h"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    VisibilityAntilagParams params;
};

#include "denoise/methods/visibility/shaders/visibility_sample.glsl"

layout(set = 0, binding = 3, r32f) uniform readonly image2D tiles;
layout(set = 0, binding = 4, rgba16f) uniform image2D moments;
UPDATE_UINT1(5, signal);

#include "denoise/methods/svgf/shaders/svgf_lag_between.glsl"

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    const float lag = lagAt(at);
    if (!(lag >= SVGF_MIN_LAG)) return;
    const vec4 before = unpackedMoments(imageLoad(moments, at));
    const float x = visibilityAt(at);
    if (before.w <= 1.0 || x < 0.0) return;
    const float frames = 1.0 + (before.w - 1.0) * (1.0 - lag);
    const vec2 had = sharesOf(before.w), more = (sharesOf(frames) - had) / max(1.0 - had, 1e-6);
    const vec4 packed = packedMoments(withSample(before, x, more, frames));
    imageStore(moments, at, packed);
    STORE_UINT1(signal, at, packedSignal(signalOf(unpackedMoments(packed))));
}
