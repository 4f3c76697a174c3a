#version 460
#extension GL_EXT_scalar_block_layout : require
// Temporal accumulation: each pixel's running mean follows its surface point from frame to frame. docs/denoising.md
// has the formulas; the idea is from D. Nehab et al., "Accelerating Real-Time Shading with Reverse Reprojection
// Caching", 2007.
#include "denoise/methods/temporal/temporal_params.h"
#include "denoise/stages/guides.glsl"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    TemporalParams params;
};
layout(constant_id = 0) const bool TWO_LIGHTS = true;  // light is diffuse + specular, else diffuse alone
READ_LAYER(1, diffuse);
READ_LAYER(2, specular);
READ_LAYER(3, albedo);
READ_UINT2(4, surfaces);
READ_LAYER(5, motion);
READ_LAYER(6, previousNormal);
READ_UINT2(7, surfacesBefore);
layout(set = 0, binding = 8, rgba32f) uniform readonly image2D colorBefore;  // mean without albedo | frames
layout(set = 0, binding = 9, rgba32f) uniform writeonly image2D color;
layout(set = 0, binding = 10, r32ui) uniform writeonly uimage2D disocclusion;

const float MAX_FLOAT = 3.4e38;

struct Past {
    vec4 mean;  // without albedo; frames in it
};

const Past NO_PAST = Past(vec4(0.0));

bool comparesInstances() {
    return params.identity != 0u;
}

Past loadFirst(ivec2 at) {
    return Past(imageLoad(colorBefore, at));
}

float framesOf(Past past) {
    return past.mean.w;
}

void loadRest(inout Past there, ivec2 at) {}

void addPast(inout Past sum, Past tap, float weight) {
    sum.mean += weight * tap.mean;
}

Past dividedBy(Past sum, float weight) {
    return Past(sum.mean / weight);
}

bool weighsNormals() {
    return false;
}

float normalScaleOf(uvec2 surface) {
    return 0.0;
}

#include "denoise/stages/reproject/history.glsl"

vec4 updated(vec4 before, vec3 x) {
    const float count = min(before.w + 1.0, params.maxHistory);
    return vec4(before.rgb + (x - before.rgb) / count, count);
}

uint failureOf(bool hit, bool onScreen, Past past) {
    if (!hit) return DISOCCLUSION_NOTHING_HIT;
    if (!onScreen) return DISOCCLUSION_OFF_SCREEN;
    return framesOf(past) > 0.0 ? DISOCCLUSION_NONE : DISOCCLUSION_NO_VALID_TAP;
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    vec3 radiance = LOAD_LAYER(diffuse, at).rgb;
    if (TWO_LIGHTS) radiance += LOAD_LAYER(specular, at).rgb;
    const vec3 divisor = modulation(LOAD_WIDE_LAYER(albedo, at), params.minAlbedo);
    const vec3 x = clamp(radiance / divisor, -MAX_FLOAT, MAX_FLOAT);
    const uvec2 surface = LOAD_UINT2(surfaces, at);
    const vec4 moved = motionAt(at, surface);

    const Past past = pastOf(at, surface, moved);
    const bool hit = distanceOf(surface) > 0.0;
    const uint failure =
        failureOf(hit, reprojectionOf(moved, vec2(pixel), vec2(params.width, params.height)).onScreen, past);
    vec4 before = past.mean;
    vec4 now = updated(before, x);
    if (failure != DISOCCLUSION_NONE) {
        before = vec4(0.0);
        const bool grey = params.greyRestart != 0u && (failure != DISOCCLUSION_NOTHING_HIT || params.greyMisses != 0u);
        now = grey ? updated(vec4(params.grey / divisor, 1.0), x) : vec4(x, 1.0);
    }
    // Near the end of float's range, resampling may overflow.
    if (!isFinite(before.rgb)) before = vec4(0.0);
    if (!isFinite(now.rgb)) now = vec4(x, 1.0);
    const bool valid = isFinite(radiance);
    imageStore(color, at, valid ? now : before);
    imageStore(disocclusion, at, uvec4(failure | (valid ? 0u : SAMPLE_REJECTED)));
}
