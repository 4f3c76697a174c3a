#version 460
#extension GL_EXT_scalar_block_layout : require
// Temporal anti-aliasing. docs/denoising.md.
#include "denoise/stages/reproject/reprojection.glsl"
#include "denoise/stages/taa/encoding.glsl"
#include "denoise/stages/taa/taa_params.h"
#include "shaders/common/filter_image.glsl"

// GPUs share the 3x3 pixels around each through shared memory. On CPUs, a barrier would cost more than loads.
#ifdef LIMPID_FILTER_BUFFERS
layout(local_size_x = 16, local_size_y = 16) in;
#else
layout(local_size_x = 8, local_size_y = 8) in;
#endif

layout(set = 0, binding = 0, scalar) uniform Params {
    TaaParams params;
};
#ifdef LIMPID_FILTER_BUFFERS
READ_LAYER(1, beauty);  // halves or floats
#define LOAD_BEAUTY(at) LOAD_LAYER(beauty, at).rgb
#else
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D beauty;
#define LOAD_BEAUTY(at) imageLoad(beauty, at).rgb
#endif
READ_LAYER(2, depth);
READ_LAYER(3, motion);
READ_HALF4(4, before);  // mean, frames in it
WRITE_HALF4(5, after);
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D smoothed;

/// How far the past may differ from the mean of the 3x3 pixels, in their standard deviations.
const float MAX_DEVIATIONS = 1.25;

/// The bend() of distances above which a surface ends or bends.
const float EDGE_BEND = 0.005;
/// The bend() of lumas below which light has no edge, and above which it has a hard one: an object's, a lamp's in its
/// ceiling, a texture's. Noise and shadows are softer, and averaged shadows would follow their light late.
const float SOFT_BEND = 0.1;
const float HARD_BEND = 0.3;
/// The part of the past frames that counts away from edges, where there is nothing to smooth: each resampling of the
/// past blurs, and it follows changes of light late.
const float INNER_SHARE = 0.15;
/// Pixels a frame. A pixel that moves less averages more frames, since the past is hardly resampled there.
const float MOVING = 0.1;

ivec2 inside(ivec2 at) {
    return clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
}

/// The pixel's encoded beauty; the distance of its surface, or 0.
vec4 loadTexel(ivec2 at) {
    return vec4(encode(LOAD_BEAUTY(inside(at))), hitDistance(LOAD_LAYER(depth, inside(at))));
}

#ifdef LIMPID_FILTER_BUFFERS
const int GROUP = 16, EDGE = GROUP + 2;
shared vec4 texels[EDGE * EDGE];  // of the group's pixels and those around it

ivec2 firstTexel() {
    return ivec2(gl_WorkGroupID.xy) * GROUP - 1;
}

/// Every invocation of the group must call this.
void shareTexels() {
    for (int i = int(gl_LocalInvocationIndex); i < EDGE * EDGE; i += GROUP * GROUP)
        texels[i] = loadTexel(firstTexel() + ivec2(i % EDGE, i / EDGE));
    barrier();
}

vec4 texelAt(ivec2 at) {
    const ivec2 inTile = at - firstTexel();
    return texels[inTile.y * EDGE + inTile.x];
}
#else
void shareTexels() {}

vec4 texelAt(ivec2 at) {
    return loadTexel(at);
}
#endif

struct Neighbourhood {
    vec3 mean, deviation;
    float brightest;  // luminance
    vec3 centre;    // the colour at the pixel's centre
    bool isEdge;
    float hardness;  // of the edges of light: 0 to 1
    ivec2 nearest;  // the pixel nearest to the eye: an edge moves with the surface in front
};

/// Weights of the three pixels around `t` in [-0.5, 0.5]: the parabola through them.
vec3 parabolaWeights(float t) {
    return vec3(0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0));
}

/// Returns the largest second difference across the middle of 3x3 values in reading order, relative to the largest of
/// its three values. These are not negative.
float bend(float values[9]) {
    float most = 0.0;
    for (int k = 0; k < 4; ++k) {
        const float a = values[k], b = values[8 - k], c = values[4];
        most = max(most, abs(a + b - 2.0 * c) / max(max(max(a, b), c), 1e-20));
    }
    return most;
}

/// `now` is the pixel's own colour, where its ray went. Sums of differences from it are accurate where the picture is flat.
Neighbourhood around(ivec2 at, vec3 now) {
    const vec3 wx = parabolaWeights(-params.jitter.x), wy = parabolaWeights(-params.jitter.y);
    vec3 sum = vec3(0.0), squares = vec3(0.0), centre = vec3(0.0), least = vec3(0.0), most = vec3(0.0);
    float brightest = encodedLuminance(now);
    float minDepth = 1e30, distances[9], lumas[9];
    ivec2 nearest = at;
    for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
            const vec4 texel = texelAt(at + ivec2(i, j));
            const vec3 v = texel.rgb - now;
            distances[3 * j + i + 4] = texel.a;  // 0 where nothing is seen
            lumas[3 * j + i + 4] = texel.x;
            sum += v;
            squares += v * v;
            centre += wx[i + 1] * wy[j + 1] * v;
            least = min(least, v);
            most = max(most, v);
            brightest = max(brightest, encodedLuminance(texel.rgb));
            if (texel.a > 0.0 && texel.a < minDepth) {
                minDepth = texel.a;
                nearest = inside(at + ivec2(i, j));
            }
        }
    }
    const vec3 mean = sum / 9.0;
    // Without these limits the parabola would overshoot beside edges, and bright light would explode in decode().
    centre = now + clamp(centre, least, most);
    centre = notBrighter(centre, brightest);
    const vec3 variance = max(squares / 9.0 - mean * mean, vec3(0.0));
    return Neighbourhood(now + mean, sqrt(variance), brightest, centre, bend(distances) > EDGE_BEND,
                         clamp((bend(lumas) - SOFT_BEND) / (HARD_BEND - SOFT_BEND), 0.0, 1.0), nearest);
}

/// Weights of the four pixels around `t` in [0, 1): the Catmull-Rom cubic.
vec4 cubicWeights(float t) {
    return vec4(t * (-0.5 + t * (1.0 - 0.5 * t)), 1.0 + t * t * (-2.5 + 1.5 * t), t * (0.5 + t * (2.0 - 1.5 * t)),
                t * t * (-0.5 + 0.5 * t));
}

vec3 encodedBefore(ivec2 at) {
    return encode(LOAD_HALF4(before, inside(at)).rgb);
}

/// At `position` (pixels, minus one half): the encoded mean, and in w the frames of the nearest pixel. The four corners
/// of 4x4 pixels, which count little, are taken as what the three pixels beside each of them let expect of a plane.
vec4 pastAt(vec2 position) {
    const vec2 corner = floor(position), share = position - corner;
    const vec4 wx = cubicWeights(share.x), wy = cubicWeights(share.y);
    const ivec2 first = ivec2(corner) - 1;
    vec3 sum = vec3(0.0);
    for (int j = 1; j <= 2; ++j) {
        for (int i = 1; i <= 2; ++i) {
            const int outerX = 3 * (i - 1), outerY = 3 * (j - 1);
            sum += (wx[i] * wy[j] - wx[outerX] * wy[outerY]) * encodedBefore(first + ivec2(i, j)) +
                   (wx[i] + wx[outerX]) * wy[outerY] * encodedBefore(first + ivec2(i, outerY)) +
                   wx[outerX] * (wy[j] + wy[outerY]) * encodedBefore(first + ivec2(outerX, j));
        }
    }
    return vec4(sum, LOAD_HALF4(before, inside(ivec2(floor(position + 0.5)))).w);
}

/// Moves the past towards the neighbourhood's mean until it is within the allowed deviations. Beside bright light these
/// reach beyond all light, to which decode() is infinite, and the cubic overshoots.
vec3 clipped(vec3 past, Neighbourhood near) {
    const vec3 off = past - near.mean;
    const vec3 excess = abs(off) / max(MAX_DEVIATIONS * near.deviation, vec3(1e-6));
    return notBrighter(near.mean + off / max(max(excess.x, max(excess.y, excess.z)), 1.0), near.brightest);
}

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    shareTexels();
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    const vec3 now = texelAt(at).rgb;
    const Neighbourhood near = around(at, now);
    const Reprojection was =
        reprojectionOf(LOAD_LAYER(motion, near.nearest), vec2(at), vec2(params.width, params.height));
    const vec4 past = was.onScreen ? pastAt(was.position) : vec4(0.0);
    const bool isJittered = params.jitter != vec2(0.0);
    const float stillness = isJittered ? max(1.0 - distance(was.position, vec2(at)) / MOVING, 0.0) : 0.0;
    const float more = stillness * near.hardness;
    const float frames = min(past.w + 1.0, mix(params.frames, params.stillFrames, more));
    const float share = isJittered && !near.isEdge ? mix(INNER_SHARE, 1.0, more) : 1.0;
    const float averaged = mix(1.0, frames, share);
    const vec3 mean = decode(mix(clipped(past.rgb, near), near.centre, 1.0 / averaged));
    STORE_HALF4(after, at, vec4(min(mean, MAX_HALF), frames));
    imageStore(smoothed, at, vec4(mean, 1.0));
}
