#version 460
#extension GL_EXT_scalar_block_layout : require
// Temporal accumulation: each pixel's running mean follows its surface point from frame to frame. docs/denoising.md has the
// formulas; the idea is from D. Nehab et al., "Accelerating Real-Time Shading with Reverse Reprojection Caching", 2007.
#include "denoise/methods/temporal/temporal_params.h"
#include "denoise/stages/reprojection.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    TemporalParams params;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D diffuse;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D specular;
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D albedo;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D normal;
layout(set = 0, binding = 5, rgba32f) uniform readonly image2D depth;
layout(set = 0, binding = 6, rgba32f) uniform readonly image2D motion;
layout(set = 0, binding = 7, rgba32f) uniform readonly image2D previousNormal;
layout(set = 0, binding = 8, rg32ui) uniform readonly uimage2D ids;
layout(set = 0, binding = 9, rgba32f) uniform readonly image2D colorBefore;  // mean | count
layout(set = 0, binding = 10, rgba32f) uniform readonly image2D normalDepthBefore;
layout(set = 0, binding = 11, rgba32f) uniform readonly image2D albedoIdBefore;
layout(set = 0, binding = 12, rgba32f) uniform writeonly image2D color;
layout(set = 0, binding = 13, rgba32f) uniform writeonly image2D normalDepth;
layout(set = 0, binding = 14, rgba32f) uniform writeonly image2D albedoId;
layout(set = 0, binding = 15, r32ui) uniform writeonly uimage2D disocclusion;

/// How a surface point must have looked in the previous frame.
struct Expected {
    vec3 normal;
    float depth, tolerance;
    float id;
};

struct Taps {
    vec4 sum;  // of means (demodulated, if asked for) and counts
    float weight;
};

void addTap(inout Taps taps, ivec2 at, float weight, Expected expected) {
    const ivec2 last = ivec2(params.width, params.height) - 1;
    const ivec2 inside = clamp(at, ivec2(0), last);
    const vec4 nd = imageLoad(normalDepthBefore, inside);
    const vec4 ai = imageLoad(albedoIdBefore, inside);
    vec4 before = imageLoad(colorBefore, inside);
    const bool counts = at == inside && before.w > 0.0 && nd.w > 0.0 && dot(expected.normal, nd.xyz) > params.normalThreshold &&
                        abs(expected.depth - nd.w) < expected.tolerance && (params.identity == 0u || ai.w == expected.id);
    if (!counts || weight <= 0.0) return;
    if (params.demodulate != 0u) before.rgb /= modulation(ai);
    taps.sum += weight * before;
    taps.weight += weight;
}

/// Mean and count that the surface point had at `position` (pixels, minus one half) in the previous frame. Nothing found:
/// a negative count.
vec4 historyAt(vec2 position, Expected expected, vec3 modulationNow) {
    const vec2 corner = floor(position), share = position - corner;
    const ivec2 first = ivec2(corner), nearest = ivec2(floor(position + 0.5));
    Taps taps = Taps(vec4(0.0), 0.0);
    addTap(taps, first, (1.0 - share.x) * (1.0 - share.y), expected);
    addTap(taps, first + ivec2(1, 0), share.x * (1.0 - share.y), expected);
    addTap(taps, first + ivec2(0, 1), (1.0 - share.x) * share.y, expected);
    // The fourth tap and the search in one loop: CPUs run the body of any loop once, but only where a pixel searches
    // more often.
    ivec2 at = first + 1;
    float weight = share.x * share.y;
    int searched = 0;
    bool more;
    do {
        addTap(taps, at, weight, expected);
        const bool failed = taps.weight <= MIN_SHARE;
        more = params.search != 0u && searched < 9 && (failed || searched > 0);
        if (failed && searched == 0) taps = Taps(vec4(0.0), 0.0);
        at = nearest + ivec2(searched % 3, searched / 3) - 1;
        weight = 1.0;
        ++searched;
    } while (more);
    if (taps.weight <= 0.0) return vec4(0.0, 0.0, 0.0, -1.0);
    vec4 before = taps.sum / taps.weight;
    if (params.demodulate != 0u) before.rgb *= modulationNow;
    return before;
}

vec4 updated(vec4 before, vec3 radiance) {
    const float count = min(before.w + 1.0, params.maxHistory);
    return vec4(before.rgb + (radiance - before.rgb) / count, count);
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    const vec3 radiance = imageLoad(diffuse, at).rgb + imageLoad(specular, at).rgb;
    const vec3 n = unitNormal(imageLoad(normal, at));
    const float z = hitDistance(imageLoad(depth, at));
    const vec3 albedoNow = finiteOr(imageLoad(albedo, at).rgb, vec3(1.0));
    const bool hit = z > 0.0;
    // Exact in a float up to 2^24 instances; beyond, some share a number.
    const float id = hit ? float((imageLoad(ids, at).x + 1u) & 0xFFFFFFu) : 0.0;

    const vec2 size = vec2(params.width, params.height);
    const Reprojection was = reprojectionOf(imageLoad(motion, at), vec2(pixel), size);
    uint failure = !hit ? DISOCCLUSION_NOTHING_HIT : !was.onScreen ? DISOCCLUSION_OFF_SCREEN : DISOCCLUSION_NONE;
    vec4 before = vec4(0.0);
    if (failure == DISOCCLUSION_NONE) {
        const float depthBefore = z + was.depthChange;
        const float tolerance =
            params.relative == 0u ? params.depthThreshold
                                  : depthTolerance(params.camera, depthBefore, n, vec2(pixel), size, params.depthThreshold);
        const Expected expected = Expected(unitNormal(imageLoad(previousNormal, at)), depthBefore, tolerance, id);
        before = historyAt(was.position, expected, modulation(vec4(albedoNow, 0.0)));
        if (before.w < 0.0) failure = DISOCCLUSION_NO_VALID_TAP;
    }
    vec4 now = updated(before, radiance);
    if (failure != DISOCCLUSION_NONE) {
        before = vec4(0.0);
        const bool grey = params.greyRestart != 0u && (failure != DISOCCLUSION_NOTHING_HIT || params.greyMisses != 0u);
        now = grey ? updated(vec4(vec3(params.grey), 1.0), radiance) : vec4(radiance, 1.0);
    }
    // Near the end of float's range resampling may overflow, too.
    if (!isFinite(before.rgb)) before = vec4(0.0);
    if (!isFinite(now.rgb)) now = vec4(radiance, 1.0);
    const bool valid = isFinite(radiance);
    imageStore(color, at, valid ? now : before);
    imageStore(normalDepth, at, vec4(hit ? n : vec3(0.0), z));
    imageStore(albedoId, at, vec4(albedoNow, id));
    imageStore(disocclusion, at, uvec4(failure | (valid ? 0u : SAMPLE_REJECTED)));
}
