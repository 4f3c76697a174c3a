#version 460
#extension GL_EXT_scalar_block_layout : require
// Converts another renderer's normals and depth from their encodings to what the surfaces stage makes of a frame's
// layers. Motion stays as it is (motion.glsl), unless anti-aliasing follows, which reads the layer.
#include "denoise/stages/guides.glsl"
#include "denoise/stages/ingest/ingest_params.h"
#include "denoise/stages/surfaces/surface_texel.glsl"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool IDS = true;        // else all is one instance
layout(constant_id = 1) const bool MOTION = true;     // store the layer
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

#include "denoise/stages/ingest/depth.glsl"
#include "denoise/stages/motion.glsl"
#include "denoise/stages/normals.glsl"

/// In halves: wrong by at most 1/128 pixel up to 32 pixels, and by 1/2048 of itself beyond.
vec4 motionAt(ivec2 at, float distance) {
    const vec4 moved = motionOfTexel(params.motion, LOAD_LAYER(motionIn, at), params.camera, vec2(at),
                                     vec2(params.width, params.height), distance);
    return nearestHalf(clamp(moved, -MAX_HALF, MAX_HALF));
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    const vec2 onScreen = pixelOnScreen(vec2(pixel) + params.motion.jitter, vec2(params.width, params.height));
    const vec3 v = viewVector(params.camera, onScreen);
    const float distance = givenDistance(LOAD_LAYER(depthIn, at).r, v);
    const bool seen = distance > 0.0;
    const vec3 n = seen ? worldNormal(LOAD_LAYER(normalIn, at), params.normals) : vec3(0.0);
    const float rough = ROUGHNESS ? LOAD_LAYER(roughnessIn, at).r : 1.0;
    const uint id = IDS ? LOAD_LAYER(idIn, at).x : 0u;
    STORE_UINT2(surfaces, at, uvec2(packedShading(unitNormal(vec4(n, 0.0)), rough), packedPlace(distance, id)));
    if (MOTION) imageStore(motion, at, motionAt(at, distance));
}
