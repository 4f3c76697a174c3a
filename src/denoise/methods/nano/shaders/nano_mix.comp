#version 460
#extension GL_EXT_scalar_block_layout : require
// Where the CPU has computed the network and its filter (nano_host.h): mixes that with SVGF's light.
#include "denoise/methods/nano/shaders/nano_storage.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool STABILISE = true;  // the next frame is stabilised by the result
layout(constant_id = 1) const bool TWO_SIGNALS = true;

layout(set = 0, binding = 0, scalar) uniform Params {
    NanoMixParams params;
};
READ_TEXELS(1, light);  // two of a pixel, as NanoHost::run() makes them
READ_HALF4(2, filteredA);
READ_HALF4(3, filteredB);
WRITE_HALF4(4, resultA);
WRITE_HALF4(5, resultB);
WRITE_UINT1(6, stableA);  // svgf_stable.glsl
WRITE_UINT1(7, stableB);

#include "denoise/methods/nano/shaders/nano_mix.glsl"

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= params.width || at.y >= params.height) return;
    const uint first = 2u * (at.y * params.pitch + at.x);
    const vec4 diffuse = uintBitsToFloat(light.texels[first]), specular = uintBitsToFloat(light.texels[first + 1u]);
    storeMixed(ivec2(at + uvec2(params.innerX, params.innerY)), diffuse.rgb, specular.rgb,
               params.strength * vec2(diffuse.a, specular.a));
}
