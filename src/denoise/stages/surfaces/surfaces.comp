#version 460
#extension GL_EXT_scalar_block_layout : require
// Packs what later passes, and the next frame, ask of a pixel's surface. docs/denoising.md, SVGF, step 1.
#include "denoise/stages/guides.glsl"
#include "denoise/stages/surfaces/surface_texel.glsl"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    uint width, height;
} params;
READ_LAYER(1, normal);
READ_LAYER(2, depth);
READ_UINT_LAYER(3, ids);
WRITE_UINT2(4, surfaces);  // surface_texel.glsl
READ_LAYER(5, roughness);
layout(constant_id = 0) const bool IDS = true;        // else all is one instance
layout(constant_id = 1) const bool ROUGHNESS = true;  // else all is rough

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    const float z = hitDistance(LOAD_LAYER(depth, at));
    const float rough = ROUGHNESS ? LOAD_LAYER(roughness, at).r : 1.0;
    const uint id = IDS ? LOAD_LAYER(ids, at).x : 0u;
    STORE_UINT2(surfaces, at, uvec2(packedShading(unitNormal(LOAD_LAYER(normal, at)), rough), packedPlace(z, id)));
}
