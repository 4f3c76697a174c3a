#version 460
#extension GL_EXT_scalar_block_layout : require
// The albedo back into the filtered light, and what the camera sees directly. docs/denoising.md, SVGF, step 8.
#include "denoise/stages/guides.glsl"
#include "denoise/methods/svgf/svgf_params.h"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool TWO_SIGNALS = false;  // else one
layout(constant_id = 1) const bool ALL_LIGHT = true;      // the one has the light of both albedos
layout(constant_id = 2) const bool EMISSION = true;       // what is seen directly is in the picture

layout(set = 0, binding = 0, scalar) uniform Params {
    SvgfModulateParams params;
};
READ_HALF4(1, signalA);
READ_HALF4(2, signalB);
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D albedoA;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D albedoB;
layout(set = 0, binding = 5, rgba32f) uniform readonly image2D emission;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D beauty;

vec3 modulated(vec3 signal, vec4 albedo) {
    return params.demodulate != 0u ? signal * modulation(albedo) : signal;
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    const vec4 a = imageLoad(albedoA, at), b = imageLoad(albedoB, at);
    vec3 light = modulated(LOAD_HALF4(signalA, at).rgb, TWO_SIGNALS || !ALL_LIGHT ? a : a + b);
    if (TWO_SIGNALS) light += modulated(LOAD_HALF4(signalB, at).rgb, b);
    if (EMISSION) light += finiteOr(imageLoad(emission, at).rgb, vec3(0.0));
    imageStore(beauty, at, vec4(light, 1.0));
}
