#version 460
#extension GL_EXT_scalar_block_layout : require
// Computes for one side and each pixel: the network's input, the light that its kernels average, and the normal by
// which kernels exclude pixels. docs/kpcn.md, "What a network sees"; training/limpid_training/features.py does the
// same.
#include "denoise/stages/guides.glsl"
#include "denoise/kpcn/shaders/kpcn_storage.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    KpcnFeaturesParams params;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D radiance;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D albedo;
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D normal;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D depth;
layout(set = 0, binding = 5, r32f) uniform readonly image2D largest;
layout(set = 0, binding = 6, scalar) writeonly buffer featureTexels { KPCN_TEXEL texels[]; } features;
layout(set = 0, binding = 7, scalar) writeonly buffer lightTexels { vec4 texels[]; } light;
layout(set = 0, binding = 8, scalar) writeonly buffer faceTexels { uint texels[]; } faces;

struct Seen {
    vec4 light, albedo, normal;  // alpha: variance
    vec2 depth;                  // distance over the largest distance; its variance
    vec4 averaged;               // the light that kernels average; alpha: variance
};

float varianceOf(float deviation) {
    return isFinite(vec3(deviation)) ? clamp(deviation * params.ofMean, 0.0, MAX_HALF) : 0.0;
}

vec4 colorAndVariance(vec4 texel) {
    return vec4(clamp(finiteOr(texel.rgb, vec3(0.0)), 0.0, MAX_HALF), varianceOf(texel.a));
}

Seen seenAt(ivec2 pixel) {
    Seen seen;
    const vec4 color = colorAndVariance(imageLoad(radiance, pixel));
    seen.albedo = colorAndVariance(imageLoad(albedo, pixel));
    vec3 linear = color.rgb;
    float variance = color.a;
    if (params.specular == 0u) {
        linear /= seen.albedo.rgb + KPCN_EPSILON;
        const float divisor = luminance(seen.albedo.rgb) + KPCN_EPSILON;
        variance /= divisor * divisor;
    }
    const float slope = 1.0 + luminance(linear);
    const vec4 logarithm = vec4(log(1.0 + linear), variance / (slope * slope));
    seen.averaged = params.specular == 0u ? vec4(linear, variance) : logarithm;
    seen.light = params.logarithmic != 0u ? logarithm : min(vec4(linear, variance), MAX_HALF);
    const vec4 n = imageLoad(normal, pixel);
    seen.normal = vec4(clamp(finiteOr(n.xyz, vec3(0.0)), -MAX_HALF, MAX_HALF), varianceOf(n.a));
    const float farthest = imageLoad(largest, ivec2(0)).x;
    const float scale = farthest > 0.0 ? 1.0 / farthest : 1.0;
    const vec4 d = imageLoad(depth, pixel);
    seen.depth = vec2(hitDistance(d) * scale, isFinite(vec3(d.a)) ? max(d.a, 0.0) * params.ofMean * scale * scale : 0.0);
    return seen;
}

/// Returns the unit normal, and in w a flag that is 1 where there is no normal. The dot product of two such vectors is
/// the cosine between the normals, 1 if neither pixel has a normal, and 0 if only one has.
vec4 faceOf(vec4 seenNormal) {
    const vec3 n = unitNormal(seenNormal);
    return dot(n, n) > 0.9 ? vec4(n, 0.0) : vec4(0.0, 0.0, 0.0, 1.0);  // the squares of very short normals underflow
}

void main() {
    if (gl_GlobalInvocationID.x >= uint(params.region.width) || gl_GlobalInvocationID.y >= uint(params.region.height)) return;
    const ivec2 pixel = ivec2(params.region.left, params.region.top) + ivec2(gl_GlobalInvocationID.xy);
    const Seen here = seenAt(pixel);
    Seen left = here, above = here;  // gradients are 0 in the first column and row
    if (pixel.x > 0) left = seenAt(pixel - ivec2(1, 0));
    if (pixel.y > 0) above = seenAt(pixel - ivec2(0, 1));
    const vec3 lightX = here.light.rgb - left.light.rgb, lightY = here.light.rgb - above.light.rgb;
    const vec3 albedoX = here.albedo.rgb - left.albedo.rgb, albedoY = here.albedo.rgb - above.albedo.rgb;
    const vec3 normalX = here.normal.xyz - left.normal.xyz, normalY = here.normal.xyz - above.normal.xyz;
    const uint first = channelTexel(params.region, 0u, pixel), second = channelTexel(params.region, 1u, pixel),
               third = channelTexel(params.region, 2u, pixel);
    features.texels[first] = toTexel(vec4(here.light.rgb, lightX.x));
    features.texels[first + 1u] = toTexel(vec4(lightX.yz, lightY.xy));
    features.texels[first + 2u] = toTexel(vec4(lightY.z, here.light.a, here.albedo.rg));
    features.texels[first + 3u] = toTexel(vec4(here.albedo.b, albedoX));
    features.texels[second] = toTexel(vec4(albedoY, here.albedo.a));
    features.texels[second + 1u] = toTexel(vec4(here.normal.xyz, normalX.x));
    features.texels[second + 2u] = toTexel(vec4(normalX.yz, normalY.xy));
    features.texels[second + 3u] = toTexel(vec4(normalY.z, here.normal.a, here.depth.x, here.depth.x - left.depth.x));
    features.texels[third] = toTexel(vec4(here.depth.x - above.depth.x, here.depth.y, 1.0, 0.0));
    for (uint i = 1u; i < 4u; ++i) features.texels[third + i] = toTexel(vec4(0.0));
    light.texels[pixelTexel(params.region, pixel)] = here.averaged;
    faces.texels[pixelTexel(params.region, pixel)] = packSnorm4x8(faceOf(here.normal));
}
