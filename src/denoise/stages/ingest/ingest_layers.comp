#version 460
#extension GL_EXT_scalar_block_layout : require
// The layers of normals and distances, for methods that read them and not only what the surfaces stage makes of them.
#include "denoise/stages/guides.glsl"
#include "denoise/stages/ingest/ingest_params.h"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    IngestParams params;
};
READ_LAYER(1, depthIn);
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D normal;
layout(set = 0, binding = 3, rg32f) uniform writeonly image2D depth;
READ_LAYER(4, normalIn);

#include "denoise/stages/ingest/depth.glsl"
#include "denoise/stages/normals.glsl"

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    const vec2 onScreen = pixelOnScreen(vec2(pixel) + params.motion.jitter, vec2(params.width, params.height));
    const float distance = givenDistance(LOAD_LAYER(depthIn, at).r, viewVector(params.camera, onScreen));
    const bool seen = distance > 0.0;
    const vec3 n = worldNormal(LOAD_LAYER(normalIn, at), params.normals);
    imageStore(normal, at, seen ? nearestHalf(vec4(n, 0.0)) : vec4(0.0));
    imageStore(depth, at, vec4(distance, seen ? 1.0 : 0.0, 0.0, 0.0));
}
