#version 460
#extension GL_EXT_scalar_block_layout : require
// Light without albedo, in half precision, and the geometry that the filter's weights need, packed.
#include "denoise/methods/atrous/atrous_params.h"
#include "denoise/stages/guides.glsl"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool TWO_LIGHTS = false;  // light is lightA + lightB, else lightA alone
layout(constant_id = 1) const bool MEAN = false;        // over frames, with their number in alpha

layout(set = 0, binding = 0, scalar) uniform Params {
    AtrousDemodulateParams params;
};
READ_LAYER(1, lightA);
READ_LAYER(2, lightB);
READ_LAYER(3, albedo);
READ_LAYER(4, normal);
READ_LAYER(5, depth);
// Light / max(albedo, min_albedo) | frames in the mean; 0: there is no light yet. Where nothing is seen: light | -1.
WRITE_HALF4(6, signal);
WRITE_UINT2(7, geometry);  // octahedral normal | depth

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    vec4 light = LOAD_LAYER(lightA, at);
    if (TWO_LIGHTS) light.rgb += LOAD_LAYER(lightB, at).rgb;
    if (!MEAN) light.a = isFinite(light.rgb) ? 1.0 : 0.0;
    const vec4 a = LOAD_WIDE_LAYER(albedo, at);
    const float z = hitDistance(LOAD_LAYER(depth, at));
    vec3 factor = modulation(a, params.givenMinAlbedo);
    if (z > 0.0) factor /= modulation(a, params.minAlbedo);
    const vec3 demodulated = finiteOr(light.rgb, vec3(0.0)) * factor;
    float d = z;
    if (params.plane != 0u) {
        const vec3 v = viewVector(params.camera, pixelOnScreen(vec2(pixel), vec2(params.width, params.height)));
        d *= inversesqrt(max(dot(v, v), 1e-30));
    }
    STORE_HALF4(signal, at, vec4(clamp(demodulated, -MAX_HALF, MAX_HALF), z > 0.0 ? min(light.a, MAX_HALF) : -1.0));
    STORE_UINT2(geometry, at, uvec2(encodeOctahedral(unitNormal(LOAD_LAYER(normal, at))), floatBitsToUint(d)));
}
