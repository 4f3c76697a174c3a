#version 460
#extension GL_EXT_scalar_block_layout : require
// Converts the caller's motion of reflections.
#include "denoise/stages/guides.glsl"
#include "denoise/stages/ingest/ingest_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    IngestParams params;
};
READ_LAYER(1, reflectionMotionIn);
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D reflectionMotion;

#include "denoise/stages/ingest/still.glsl"

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    const vec3 moved = params.hasPrevious != 0u ? LOAD_LAYER(reflectionMotionIn, at).xyz : vec3(0.0);
    // All zero says that there is no reflection to follow.
    const float valid = moved != vec3(0.0) ? 1.0 : 0.0;
    imageStore(reflectionMotion, at,
               storedMotion(vec4(moved.xy * params.motionToPixels, moved.z * params.motionToDistance, valid)));
}
