#version 460
#extension GL_EXT_scalar_block_layout : require
// Converts linear radiance to display values, like image/tonemap.h does for files.
#include "image/tonemap_curve.h"
#include "passes/tonemap/tonemap_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool SUM_OF_TWO = false;  // radiance + added

layout(set = 0, binding = 0, scalar) uniform Params {
    TonemapParams params;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D radiance;
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D added;
#ifdef LIMPID_EXTENDED  // for displays of a high dynamic range: 1 is paper white, and may be exceeded
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D display;
#else
layout(set = 0, binding = 2, rgba8) uniform writeonly image2D display;
#endif

vec3 filmicCurve(vec3 value) {
    const vec3 x = filmicScale * min(value, vec3(filmicLargest));
    return min(x * (filmicA * x + filmicB) / (x * (filmicC * x + filmicD) + filmicE), vec3(1.0));
}

vec3 srgbEncode(vec3 linear) {
    return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}

vec3 agx(vec3 exposed) {
    const float factors[7] = float[7](LIMPID_AGX_CONTRAST);
    const vec3 value = mat3(LIMPID_AGX_INSET) * min(exposed, vec3(filmicLargest));
    // The logarithm of 0 is not defined.
    const vec3 stops = clamp(log2(max(value, vec3(1e-6))), vec3(agxMinStops), vec3(agxMaxStops));
    const vec3 x = (stops - agxMinStops) / (agxMaxStops - agxMinStops);
    vec3 y = vec3(0.0);
    for (int i = 0; i < 7; ++i) y = y * x + factors[i];
    return clamp(mat3(LIMPID_AGX_OUTSET) * y, vec3(0.0), vec3(1.0));
}

vec3 falseColor(vec3 exposed) {
    const vec3 colors[2 * falseColorStops + 1] = vec3[2 * falseColorStops + 1](LIMPID_FALSE_COLORS);
    const float luminance = dot(min(exposed, vec3(filmicLargest)), vec3(0.2126, 0.7152, 0.0722));
    const float most = float(falseColorStops);
    const float stops = clamp(log2(max(luminance, 1e-6) / filmicKey), -most, most);
    return colors[int(floor(stops + most + 0.5))];
}

#ifdef LIMPID_EXTENDED
/// As image::extendedColor().
vec3 displayColor(vec3 exposed) {
    return srgbEncode(min(exposed, vec3(extendedLargest)));
}
#else
/// As image::displayColor().
vec3 displayColor(vec3 exposed) {
    switch (params.curve) {
        case 1: return agx(exposed);
        case 2: return srgbEncode(min(exposed, vec3(1.0)));
        case 3: return falseColor(exposed);
        default: return srgbEncode(filmicCurve(exposed));
    }
}
#endif

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    vec3 exposed = imageLoad(radiance, ivec2(pixel)).rgb;
    if (SUM_OF_TWO) exposed += imageLoad(added, ivec2(pixel)).rgb;
    exposed *= params.scale;
    const vec3 usable = mix(vec3(0.0), exposed, greaterThan(exposed, vec3(0.0)));  // neither NaN nor below 0
    imageStore(display, ivec2(pixel), vec4(displayColor(usable), 1.0));
}
