#version 460
#extension GL_EXT_scalar_block_layout : require
// Converts another renderer's normals, depth and motion from their encodings: the first two to what the surfaces stage
// makes of a frame's layers, motion to the layer (docs/denoising.md, "What a frame gives").
#include "denoise/stages/guides.glsl"
#include "denoise/stages/ingest/ingest_params.h"
#include "denoise/stages/surfaces/surface_texel.glsl"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool IDS = true;        // else all is one instance
layout(constant_id = 1) const bool MOTION = true;     // else everything stands still
layout(constant_id = 2) const bool ROUGHNESS = true;  // else all is rough

layout(set = 0, binding = 0, scalar) uniform Params {
    IngestParams params;
};
READ_LAYER(1, normalIn);
READ_LAYER(2, depthIn);
READ_LAYER(3, motionIn);
READ_UINT_LAYER(4, idIn);
READ_LAYER(7, roughnessIn);
WRITE_UINT2(5, surfaces);  // surface_texel.glsl
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D motion;

#include "denoise/stages/normals.glsl"
#include "denoise/stages/ingest/still.glsl"

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
    if (MOTION) {
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
    const vec3 n = seen ? worldNormal(LOAD_LAYER(normalIn, at), params.normals) : vec3(0.0);
    const float rough = ROUGHNESS ? LOAD_LAYER(roughnessIn, at).r : 1.0;
    const uint id = IDS ? LOAD_LAYER(idIn, at).x : 0u;
    STORE_UINT2(surfaces, at, uvec2(packedShading(unitNormal(vec4(n, 0.0)), rough), packedPlace(distance, id)));
    const vec4 point = seen ? vec4(positionOf(distance, v, onScreen), 1.0) : vec4(v, 0.0);
    imageStore(motion, at, params.hasPrevious != 0u ? storedMotion(motionOf(at, point, distance)) : vec4(0.0));
}
