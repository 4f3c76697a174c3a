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
layout(set = 0, binding = 2, rgba8) uniform writeonly image2D display;

vec3 filmicCurve(vec3 value) {
    const vec3 x = filmicScale * min(value, vec3(filmicLargest));
    return min(x * (filmicA * x + filmicB) / (x * (filmicC * x + filmicD) + filmicE), vec3(1.0));
}

vec3 srgbEncode(vec3 linear) {
    return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear, lessThanEqual(linear, vec3(0.0031308)));
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    vec3 exposed = imageLoad(radiance, ivec2(pixel)).rgb;
    if (SUM_OF_TWO) exposed += imageLoad(added, ivec2(pixel)).rgb;
    exposed *= params.scale;
    const vec3 usable = mix(vec3(0.0), exposed, greaterThan(exposed, vec3(0.0)));  // neither NaN nor below 0
    imageStore(display, ivec2(pixel), vec4(srgbEncode(filmicCurve(usable)), 1.0));
}
