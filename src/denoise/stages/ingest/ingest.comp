#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_samplerless_texture_functions : require
// Converts another renderer's frame from its encodings to what the denoisers read (docs/denoising.md, "What a frame
// gives"). Inputs that the caller does not have are bound to another one and not read.
#include "denoise/stages/guides.glsl"
#include "denoise/stages/ingest/ingest_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    IngestParams params;
};
layout(set = 0, binding = 1) uniform texture2D radianceIn;
layout(set = 0, binding = 2) uniform texture2D specularIn;
layout(set = 0, binding = 3) uniform texture2D emissionIn;
layout(set = 0, binding = 4) uniform texture2D albedoIn;
layout(set = 0, binding = 5) uniform texture2D albedoSpecularIn;
layout(set = 0, binding = 6) uniform texture2D normalIn;
layout(set = 0, binding = 7) uniform texture2D depthIn;
layout(set = 0, binding = 8) uniform texture2D motionIn;
layout(set = 0, binding = 9) uniform texture2D previousNormalIn;
layout(set = 0, binding = 10) uniform texture2D reflectionMotionIn;
layout(set = 0, binding = 11, rgba32f) uniform writeonly image2D diffuse;
layout(set = 0, binding = 12, rgba32f) uniform writeonly image2D specular;
layout(set = 0, binding = 13, rgba32f) uniform writeonly image2D emission;
layout(set = 0, binding = 14, rgba32f) uniform writeonly image2D albedo;
layout(set = 0, binding = 15, rgba32f) uniform writeonly image2D albedoSpecular;
layout(set = 0, binding = 16, rgba32f) uniform writeonly image2D normal;
layout(set = 0, binding = 17, rgba32f) uniform writeonly image2D depth;
layout(set = 0, binding = 18, rgba32f) uniform writeonly image2D motion;
layout(set = 0, binding = 19, rgba32f) uniform writeonly image2D reflectionMotion;
layout(set = 0, binding = 20, rgba32f) uniform writeonly image2D previousNormal;
layout(set = 0, binding = 21, rg32ui) uniform writeonly uimage2D ids;

#include "denoise/stages/ingest/still.glsl"

bool has(uint what) {
    return (params.present & what) != 0u;
}

vec3 colorOr(uint what, texture2D image, ivec2 at, vec3 otherwise) {
    return has(what) ? texelFetch(image, at, 0).rgb : otherwise;
}

/// Decodes octahedral coordinates, -1 to 1: Z. H. Cigolle et al., "A Survey of Efficient Representations for
/// Independent Unit Vectors", JCGT 2014.
vec3 fromOctahedral(vec2 e) {
    const vec3 v = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    const vec2 folded = (1.0 - abs(v.yx)) * vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
    return normalize(vec3(v.z < 0.0 ? folded : v.xy, v.z));
}

vec3 worldNormal(vec4 texel) {
    vec3 n = texel.xyz;
    if (params.normalEncoding == NORMAL_UNORM) n = 2.0 * n - 1.0;
    if (params.normalEncoding == NORMAL_OCTAHEDRAL_SIGNED) n = fromOctahedral(n.xy);
    if (params.normalEncoding == NORMAL_OCTAHEDRAL_UNORM) n = fromOctahedral(2.0 * n.xy - 1.0);
    if (params.normalInView != 0u) n = n.x * params.viewX + n.y * params.viewY + n.z * params.viewZ;
    return n;
}

/// The distance along the ray; 0 where nothing is seen. `v` is the ray; its component along the view axis is 1.
float distanceOf(float z, vec3 v) {
    if (params.depthKind == DEPTH_DEVICE) {
        if (params.reversed != 0u ? !(z > 0.0) : !(z < 1.0)) return 0.0;
        const vec4 p = params.deviceDepth;
        z = abs((z * p.w - p.y) / (p.x - z * p.z));
    } else {
        if (params.depthKind == DEPTH_LINEAR) z = abs(z);
        if (!(z > 0.0 && z < params.farDepth)) return 0.0;
    }
    const bool alongRay = params.depthKind == DEPTH_DISTANCE || params.camera.orthographic != 0u;
    const float distance = alongRay ? z : z * length(v);
    return isinf(distance) ? 0.0 : distance;
}

vec4 motionOf(ivec2 at, vec4 point, float distance) {
    vec4 result;
    if (has(INGEST_MOTION)) {
        const vec3 moved = texelFetch(motionIn, at, 0).xyz;
        result = vec4(moved.xy * params.motionToPixels, moved.z * params.motionToDistance, 1.0);
        if (params.motionToDistance != 0.0) return result;
    } else {
        result = motionOfStill(point, vec2(at));
    }
    if (point.w != 0.0) result.z = previousDistance(point.xyz) - distance;
    return result;
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    imageStore(diffuse, at, vec4(texelFetch(radianceIn, at, 0).rgb, 0.0));
    imageStore(specular, at, vec4(colorOr(INGEST_SPECULAR, specularIn, at, vec3(0.0)), 0.0));
    imageStore(emission, at, vec4(colorOr(INGEST_EMISSION, emissionIn, at, vec3(0.0)), 0.0));
    imageStore(albedo, at, vec4(colorOr(INGEST_ALBEDO, albedoIn, at, vec3(1.0)), 0.0));
    const vec3 noLobe = vec3(params.twoSignals != 0u ? 1.0 : 0.0);
    imageStore(albedoSpecular, at, vec4(colorOr(INGEST_ALBEDO_SPECULAR, albedoSpecularIn, at, noLobe), 0.0));

    const vec2 onScreen = pixelOnScreen(vec2(pixel) + params.jitter, vec2(params.width, params.height));
    const vec3 v = viewVector(params.camera, onScreen);
    const float distance = distanceOf(texelFetch(depthIn, at, 0).r, v);
    const bool seen = distance > 0.0;
    const vec3 n = seen ? worldNormal(texelFetch(normalIn, at, 0)) : vec3(0.0);
    const vec3 nBefore = has(INGEST_PREVIOUS_NORMAL) && seen ? worldNormal(texelFetch(previousNormalIn, at, 0)) : n;
    imageStore(normal, at, vec4(n, 0.0));
    imageStore(previousNormal, at, vec4(nBefore, 0.0));
    imageStore(depth, at, vec4(distance, seen ? 1.0 : 0.0, 0.0, 0.0));

    const bool moves = params.hasPrevious != 0u;
    const vec4 point = seen ? vec4(positionOf(distance, v, onScreen), 1.0) : vec4(v, 0.0);
    imageStore(motion, at, moves ? motionOf(at, point, distance) : vec4(0.0));
    const bool reflects = seen && moves && has(INGEST_REFLECTION_MOTION);
    const vec4 mirrored = reflects ? texelFetch(reflectionMotionIn, at, 0) : vec4(0.0);
    // All zero says that there is no reflection to follow.
    const float valid = mirrored.xyz != vec3(0.0) ? 1.0 : 0.0;
    imageStore(reflectionMotion, at,
               vec4(mirrored.xy * params.motionToPixels, mirrored.z * params.motionToDistance, valid));
    imageStore(ids, at, uvec4(seen ? 0u : 0xFFFFFFFFu));
}
