#version 460
#extension GL_EXT_scalar_block_layout : require
// Converts another renderer's normals, depth and motion from their encodings to what the denoisers read
// (docs/denoising.md, "What a frame gives"). Inputs that the caller does not have are bound to another one and not read.
// INGEST_PREVIOUS_NORMAL: the caller has the previous frame's normals, too.
#include "denoise/stages/guides.glsl"
#include "denoise/stages/ingest/ingest_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    IngestParams params;
};
READ_LAYER(1, normalIn);
READ_LAYER(2, depthIn);
READ_LAYER(3, motionIn);
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D normal;
layout(set = 0, binding = 5, rg32f) uniform writeonly image2D depth;
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D motion;
#ifdef INGEST_PREVIOUS_NORMAL
READ_LAYER(7, previousNormalIn);
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D previousNormal;
#endif

#include "denoise/stages/ingest/still.glsl"

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
    // Already unit vectors keep their bits.
    return abs(dot(n, n) - 1.0) < 2e-3 ? n : unitNormal(vec4(n, 0.0));
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

/// As ingest_params.h says of motion.
vec4 motionOf(ivec2 at, vec4 point, float distance) {
    vec4 result;
    if (params.hasMotion != 0u) {
        const vec3 moved = LOAD_LAYER(motionIn, at).xyz;
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
    const vec2 onScreen = pixelOnScreen(vec2(pixel) + params.jitter, vec2(params.width, params.height));
    const vec3 v = viewVector(params.camera, onScreen);
    const float distance = distanceOf(LOAD_LAYER(depthIn, at).r, v);
    const bool seen = distance > 0.0;
    imageStore(depth, at, vec4(distance, seen ? 1.0 : 0.0, 0.0, 0.0));
    const vec3 n = seen ? worldNormal(LOAD_LAYER(normalIn, at)) : vec3(0.0);
    imageStore(normal, at, nearestHalf(vec4(n, 0.0)));
#ifdef INGEST_PREVIOUS_NORMAL
    const vec3 nBefore = seen ? worldNormal(LOAD_LAYER(previousNormalIn, at)) : vec3(0.0);
    imageStore(previousNormal, at, nearestHalf(vec4(nBefore, 0.0)));
#endif
    const vec4 point = seen ? vec4(positionOf(distance, v, onScreen), 1.0) : vec4(v, 0.0);
    imageStore(motion, at, params.hasPrevious != 0u ? storedMotion(motionOf(at, point, distance)) : vec4(0.0));
}
