// Texture look-up from texel buffers: wrap modes, nearest and bilinear filters and mip levels according to
// glTF's samplers (glTF 2.0, section 3.8.4; OpenGL ES 3.0, section 3.8.10), and the mean over a ray's
// footprint.
#ifndef LIMPID_TEXTURE_GLSL
#define LIMPID_TEXTURE_GLSL

#include "shaders/common/scene_data.glsl"

struct TextureRef {
    vec3 rowU, rowV;
    uint firstTexel, flags, width, height, levels;
};

TextureRef loadTextureRef(uint index) {
    const int at = int(index * TEXTURE_REF_TEXELS);
    const uvec4 a = imageLoad(textureRefs, at), b = imageLoad(textureRefs, at + 1), c = imageLoad(textureRefs, at + 2);
    return TextureRef(uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), a.w, b.w, c.x, c.y, c.z);
}

uint loadTexel(uint index) {
    const int at = int(index & ((1u << TEXEL_BUFFER_SHIFT) - 1u));
    const uint buffer_ = index >> TEXEL_BUFFER_SHIFT;
    if (TEXEL_BUFFER_COUNT > 3 && buffer_ == 3u) return imageLoad(texels3, at).x;
    if (TEXEL_BUFFER_COUNT > 2 && buffer_ == 2u) return imageLoad(texels2, at).x;
    if (TEXEL_BUFFER_COUNT > 1 && buffer_ == 1u) return imageLoad(texels1, at).x;
    return imageLoad(texels0, at).x;
}

vec4 decodeTexel(uint texel, bool srgb) {
    const vec4 c = unpackUnorm4x8(texel);
    const vec3 linear = mix(pow((c.rgb + 0.055) / 1.055, vec3(2.4)), c.rgb / 12.92, lessThanEqual(c.rgb, vec3(0.04045)));
    return vec4(srgb ? linear : c.rgb, c.a);
}

int wrapTexel(int x, int size, uint mode) {
    if (mode == 1u) return clamp(x, 0, size - 1);
    const int period = mode == 2u ? 2 * size : size;
    // Integer division: in float, some GPUs round an integer quotient to just below itself.
    const int remainder = x - period * (x / period);
    const int m = remainder < 0 ? remainder + period : remainder;
    return clamp(mode == 2u && m >= size ? period - 1 - m : m, 0, size - 1);
}

/// `filtered` false: the nearest texel. Reads one mip level.
vec4 sampleLevel(TextureRef ref, vec2 uv, uint level, bool filtered) {
    uint first = ref.firstTexel;
    uint width = ref.width, height = ref.height;
    for (uint i = 0u; i < level; ++i) {
        first += width * height;
        width = max(1u, width >> 1);
        height = max(1u, height >> 1);
    }
    const uint wrapU = (ref.flags >> TEXTURE_WRAP_U_SHIFT) & 3u, wrapV = (ref.flags >> TEXTURE_WRAP_V_SHIFT) & 3u;
    const bool srgb = (ref.flags & TEXTURE_SRGB) != 0u;
    // Large coordinates would overflow the integers, and have no fraction left anyway.
    const vec2 p = clamp(uv * vec2(width, height), vec2(-1e8), vec2(1e8)) - (filtered ? 0.5 : 0.0);
    const ivec2 base = ivec2(floor(p));
    const vec2 f = filtered ? p - floor(p) : vec2(0.0);
    const int x0 = wrapTexel(base.x, int(width), wrapU), x1 = wrapTexel(base.x + 1, int(width), wrapU);
    const uint row0 = first + uint(wrapTexel(base.y, int(height), wrapV)) * width;
    const uint row1 = first + uint(wrapTexel(base.y + 1, int(height), wrapV)) * width;
    const vec4 top = mix(decodeTexel(loadTexel(row0 + uint(x0)), srgb), decodeTexel(loadTexel(row0 + uint(x1)), srgb), f.x);
    const vec4 bottom =
        mix(decodeTexel(loadTexel(row1 + uint(x0)), srgb), decodeTexel(loadTexel(row1 + uint(x1)), srgb), f.x);
    return mix(top, bottom, f.y);
}

/// Returns the mean of `taps` points, starting at `first`, with the spacing `step_`. `lod`: log2 of the
/// footprint in texels.
vec4 sampleTaps(TextureRef ref, vec2 first, vec2 step_, uint taps, float lod) {
    const uint mip = (ref.flags >> TEXTURE_MIP_SHIFT) & 3u;
    const bool minified = lod > 0.0;
    const bool filtered = (ref.flags & (minified ? TEXTURE_MIN_LINEAR : TEXTURE_MAG_LINEAR)) != 0u;
    const float level = mip != 0u && minified ? min(lod, float(ref.levels - 1u)) : 0.0;
    const uint finer = uint(mip == 2u ? level : level + 0.5);
    const float fraction = mip == 2u ? level - floor(level) : 0.0;
    const uint levels = fraction > 0.0 ? 2u : 1u;
    vec4 sum = vec4(0.0);
    // A single loop instead of nested ones, since CPUs run the body of each once more, masked. (With the test
    // at the end of the body, lavapipe 22.3 keeps adding in lanes that have finished.)
    const uint count = taps * levels;
    for (uint i = 0u; i < count; ++i) {
        const uint coarser = i & (levels - 1u);
        const vec2 uv = first + float(i >> (levels - 1u)) * step_;
        sum += (coarser == 0u ? 1.0 - fraction : fraction) * sampleLevel(ref, uv, finer + coarser, filtered);
    }
    return sum / float(taps);
}

/// `uv` is already transformed; `lod`: log2 of the footprint in texels.
vec4 sampleTexture(TextureRef ref, vec2 uv, float lod) {
    return sampleTaps(ref, uv, vec2(0.0), 1u, lod);
}

/// The maximum number of taps along a footprint's long axis. Longer footprints use coarser levels.
const uint MAX_TAPS = 4u;

/// The width, in texels, of the box that blurs as much as a level's own filter. A texel is a mean over a box, and
/// bilinear interpolation makes a tent of it: variances of 1/12 and 1/6 texels, as much as that of a box sqrt(3) wide.
const float LEVEL_FILTER = 1.7320508;

/// Returns the mean over a parallelogram around `uv` with these axes (full widths, in units of uv). The short
/// extent selects the level, and taps lie along the long one (A. Schilling et al., "Texram", IEEE CG&A 1996). Together
/// they have the variance of the parallelogram along both axes, whatever the number of taps.
/// Without mip levels: one tap, according to the sampler. `exact` false: one tap in one level, for the same
/// area.
vec4 sampleFootprint(TextureRef ref, vec2 uv, vec2 across, vec2 along, bool exact) {
    const vec2 size = vec2(ref.width, ref.height);
    const vec2 a = across * size, b = along * size;
    const bool firstLonger = dot(a, a) > dot(b, b);
    const float longExtent = max(sqrt(max(dot(a, a), dot(b, b))), 1e-20);
    const float area = abs(a.x * b.y - a.y * b.x);
    const float shortExtent = max(area / longExtent, longExtent / float(MAX_TAPS));
    const bool oneTap = !exact || ((ref.flags >> TEXTURE_MIP_SHIFT) & 3u) == 0u;
    // Within a texel, several taps would make no difference.
    const float wanted = min(ceil(longExtent / max(shortExtent, 1.0)), float(MAX_TAPS));
    const uint taps = oneTap ? 1u : max(uint(wanted), 1u);
    const vec2 step_ = (firstLonger ? across : along) / float(taps);
    const vec2 first = uv - 0.5 * float(taps - 1u) * step_;
    const float lod = exact ? log2(shortExtent / LEVEL_FILTER) : floor(0.5 * log2(max(area, 1e-20)) + 0.5);
    return sampleTaps(ref, first, step_, taps, lod);
}

#endif
