#version 460
#extension GL_EXT_scalar_block_layout : require
// Converts the caller's normals of the previous frame.
#include "denoise/stages/guides.glsl"
#include "denoise/stages/ingest/ingest_params.h"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    IngestParams params;
};
READ_LAYER(1, previousNormalIn);
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D previousNormal;

#include "denoise/stages/ingest/normals.glsl"

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    imageStore(previousNormal, at, nearestHalf(vec4(worldNormal(LOAD_LAYER(previousNormalIn, at)), 0.0)));
}
