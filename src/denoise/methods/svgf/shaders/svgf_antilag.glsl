// Anti-lag: where the light has changed, removes most of the history from the accumulated mean. docs/denoising.md,
// SVGF, step 4.
#include "denoise/methods/svgf/svgf_params.h"

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfAntilagParams params;
};

#include "denoise/methods/svgf/shaders/svgf_signal.glsl"

layout(set = 0, binding = 5, r32f) uniform readonly image2D tiles;
layout(set = 0, binding = 6, rgba16f) uniform image2D moments;
UPDATE_HALF4(7, color);

#include "denoise/methods/svgf/shaders/svgf_lag_between.glsl"

void shorten(ivec2 at, float lag) {
    if (!(lag >= SVGF_MIN_LAG)) return;
    const vec4 before = unpackedMoments(imageLoad(moments, at));
    const vec4 light = lightAt(at);
    if (before.w <= 1.0 || !isFinite(light.rgb)) return;
    const vec3 x = demodulated(light.rgb, at);
    const vec2 now = momentsOf(x, light);
    const float frames = 1.0 + (before.w - 1.0) * (1.0 - lag);
    const vec4 alphas = vec4(params.alphaMoments, params.alphaMoments, params.alphaFast, params.alpha);
    const vec4 had = max(alphas, 1.0 / before.w), has = max(alphas, 1.0 / frames);
    const vec4 more = (has - had) / max(1.0 - had, 1e-6);
    const float length = frames > 1.0 ? frames : SVGF_SHORTENED;
    const vec4 packed = packedMoments(vec4(mix(before.xyz, vec3(now, now.x), more.xyz), length));
    imageStore(moments, at, packed);
    const vec3 mean = mix(LOAD_HALF4(color, at).rgb, x, more.w);
    STORE_HALF4(color, at, vec4(mean, deviationOf(unpackedMoments(packed))));
}
