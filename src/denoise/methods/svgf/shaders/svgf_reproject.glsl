// Temporal accumulation of one signal: its color, and the first two moments of its luminance. docs/denoising.md, SVGF,
// steps 2 and 3.
#include "denoise/methods/svgf/svgf_params.h"
#include "denoise/stages/guides.glsl"
#include "denoise/stages/reproject/lobe.glsl"
#include "denoise/stages/surfaces/surface_texel.glsl"

layout(constant_id = 1) const bool REFLECTIONS = false;  // follow the reflected image instead of the surface
layout(constant_id = 3) const bool STABILISE = false;    // reproject the stabilised light, too
layout(constant_id = 9) const bool LOBES = false;        // the past's normals weigh, as far as the lobe is narrow

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfReprojectParams params;
};

#include "denoise/methods/svgf/shaders/svgf_signal.glsl"
#include "denoise/methods/svgf/shaders/svgf_stable.glsl"

READ_LAYER(5, motion);
READ_LAYER(6, previousNormal);
READ_LAYER(16, reflectionMotion);
READ_UINT2(7, surfaces);
READ_UINT2(8, surfacesBefore);
READ_HALF4(11, colorBefore);
layout(set = 0, binding = 12, rgba16f) uniform readonly image2D momentsBefore;
WRITE_HALF4(14, color);                                                // light without albedo | deviation, or SVGF_*
layout(set = 0, binding = 15, rgba16f) uniform writeonly image2D moments;  // svgf_moments.glsl
READ_UINT1(18, stableBefore);  // svgf_stable.glsl
WRITE_UINT1(13, stablePast);

struct Past {
    vec3 color, stable;
    vec4 moments;
};

const Past NO_PAST = Past(vec3(0.0), vec3(0.0), vec4(0.0));

bool comparesInstances() {
    return true;
}

Past loadFirst(ivec2 at) {
    Past there = NO_PAST;
    there.moments = unpackedMoments(imageLoad(momentsBefore, at));
    if (there.moments.w > 0.0) there.moments.w = max(there.moments.w, 1.0);  // SVGF_SHORTENED
    return there;
}

float framesOf(Past past) {
    return past.moments.w;
}

void loadRest(inout Past there, ivec2 at) {
    there.color = LOAD_HALF4(colorBefore, at).rgb;
    if (STABILISE) there.stable = unpackedStable(LOAD_UINT1(stableBefore, at));
}

void addPast(inout Past sum, Past tap, float weight) {
    sum.color += weight * tap.color;
    sum.stable += weight * tap.stable;
    sum.moments += weight * tap.moments;
}

Past dividedBy(Past sum, float weight) {
    return Past(sum.color / weight, sum.stable / weight, sum.moments / weight);
}

bool weighsNormals() {
    return LOBES;
}

float normalScaleOf(uvec2 surface) {
    return lobeNormalScale(roughnessOf(surface), params.lobeScale);
}

#include "denoise/stages/reproject/history.glsl"
#include "denoise/stages/reproject/reflection_motion.glsl"

/// `first`: the moments of a history's first frame.
Past accumulated(Past past, vec3 x, vec2 first) {
    const float frames = min(past.moments.w + 1.0, params.longest);
    const float l = luminance(x), square = past.moments.w > 0.0 ? l * l : first.y;
    const vec3 alphas = max(vec3(params.alphaMoments, params.alphaMoments, params.alphaFast), 1.0 / frames);
    return Past(mix(past.color, x, max(params.alpha, 1.0 / frames)), past.stable,
                vec4(mix(past.moments.xyz, vec3(l, square, l), alphas), frames));
}

/// Returns the moments, as they are stored.
vec4 accumulate(ivec2 at) {
    const vec4 light = lightAt(at);
    const vec3 x = demodulated(light.rgb, at);
    const uvec2 surface = LOAD_UINT2(surfaces, at);
    Past now = NO_PAST;
    if (REFLECTIONS) now = pastOf(at, surface, reflectionMotionAt(at));
    if (framesOf(now) <= 0.0) now = pastOf(at, surface, motionAt(at, surface));
    if (isFinite(light.rgb)) now = accumulated(now, x, momentsOf(x, light));
    const bool seen = distanceOf(surface) > 0.0;
    const vec4 packed = seen ? packedMoments(now.moments) : vec4(0.0), stored = unpackedMoments(packed);
    imageStore(moments, at, packed);
    // Not divided by the albedo of nothing, which would take bright skies beyond the largest half.
    const vec3 own = clamp(finiteOr(light.rgb, vec3(0.0)), -MAX_HALF, MAX_HALF);
    STORE_HALF4(color, at, seen ? vec4(now.color, deviationOf(stored)) : vec4(own, SVGF_NOTHING_SEEN));
    if (STABILISE) STORE_UINT1(stablePast, at, packedStable(now.stable));
    return stored;
}
