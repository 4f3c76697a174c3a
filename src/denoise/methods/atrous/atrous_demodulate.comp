#version 460
#extension GL_EXT_scalar_block_layout : require
// Light without albedo, in half precision, and the geometry that the filter's weights need, packed.
#include "denoise/methods/atrous/atrous_params.h"
#include "denoise/stages/guides.glsl"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool SUM_OF_TWO = false;  // one frame's light in two images; else a mean over frames in lightA

layout(set = 0, binding = 0, scalar) uniform Params {
    AtrousDemodulateParams params;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D lightA;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D lightB;
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D albedo;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D normal;
layout(set = 0, binding = 5, rgba32f) uniform readonly image2D depth;
WRITE_HALF4(6, signal);    // light / max(albedo, min_albedo) | frames in the mean
WRITE_UINT2(7, geometry);  // octahedral normal | depth

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    vec4 light = imageLoad(lightA, at);
    if (SUM_OF_TWO) light = vec4(light.rgb + imageLoad(lightB, at).rgb, 1.0);
    const vec4 a = imageLoad(albedo, at);
    const vec3 factor = modulation(a, params.givenMinAlbedo) / modulation(a, params.minAlbedo);
    const vec3 demodulated = finiteOr(light.rgb, vec3(0.0)) * factor;
    const float z = hitDistance(imageLoad(depth, at));
    float d = z;
    if (params.plane != 0u) {
        const vec3 v = viewVector(params.camera, pixelOnScreen(vec2(pixel), vec2(params.width, params.height)));
        d *= inversesqrt(max(dot(v, v), 1e-30));
    }
    STORE_HALF4(signal, at, vec4(clamp(demodulated, -MAX_HALF, MAX_HALF), min(light.a, MAX_HALF)));
    STORE_UINT2(geometry, at, uvec2(encodeOctahedral(unitNormal(imageLoad(normal, at))), floatBitsToUint(d)));
}
