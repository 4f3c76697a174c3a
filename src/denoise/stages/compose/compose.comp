#version 460
#extension GL_EXT_scalar_block_layout : require
// The picture: filtered light times its albedo, plus emission. docs/denoising.md, SVGF, step 8. Light with a negative
// fourth component, where nothing is seen, has not been divided by albedo.
// LIMPID_COMPOSE_FLOAT: the light is in float images; otherwise in halves (shaders/common/filter_image.glsl).
// LIMPID_COMPOSE_HALF, _HALF_BUFFERS and _HALF_FLOAT: the picture is in halves; with light in buffers, in float images.
#ifdef LIMPID_COMPOSE_HALF_BUFFERS
#define LIMPID_COMPOSE_HALF
#define LIMPID_FILTER_BUFFERS
#endif
#ifdef LIMPID_COMPOSE_HALF_FLOAT
#define LIMPID_COMPOSE_HALF
#define LIMPID_COMPOSE_FLOAT
#endif
#include "denoise/stages/compose/compose_params.h"
#include "denoise/stages/guides.glsl"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint ALBEDOS = 1u;           // 1: the first light's albedo; 2: both albedos reflect it
layout(constant_id = 1) const bool SECOND = false;         // there is a second light, with the second albedo
layout(constant_id = 2) const bool EMISSION = true;

layout(set = 0, binding = 0, scalar) uniform Params {
    ComposeParams params;
};
#ifdef LIMPID_COMPOSE_FLOAT
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D lightA;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D lightB;
#define LOAD_LIGHT(name, at) imageLoad(name, at)
#else
READ_HALF4(1, lightA);
READ_HALF4(2, lightB);
#define LOAD_LIGHT(name, at) LOAD_HALF4(name, at)
#endif
READ_LAYER(3, albedoA);
READ_LAYER(4, albedoB);
READ_LAYER(5, emission);
#ifdef LIMPID_COMPOSE_HALF
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D beauty;
#define STORED(color) nearestHalf(clamp(color, vec4(-MAX_HALF), vec4(MAX_HALF)))
#else
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D beauty;
#define STORED(color) (color)
#endif

vec3 modulated(vec4 light, vec4 albedo) {
    return light.a < 0.0 ? light.rgb : light.rgb * modulation(albedo, params.minAlbedo);
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    vec4 albedo = LOAD_WIDE_LAYER(albedoA, at);
    if (ALBEDOS == 2u) albedo += LOAD_WIDE_LAYER(albedoB, at);
    vec3 light = modulated(LOAD_LIGHT(lightA, at), albedo);
    if (SECOND) light += modulated(LOAD_LIGHT(lightB, at), LOAD_WIDE_LAYER(albedoB, at));
    if (EMISSION) light += finiteOr(LOAD_LAYER(emission, at).rgb, vec3(0.0));
    imageStore(beauty, at, STORED(vec4(light, 1.0)));
}
