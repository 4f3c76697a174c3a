// Writes every format.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32f) uniform writeonly image2D r32Float;
layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D r32Uint;
layout(set = 0, binding = 2, rg32f) uniform writeonly image2D rg32Float;
layout(set = 0, binding = 3, rg32ui) uniform writeonly uimage2D rg32Uint;
layout(set = 0, binding = 4, rgba32f) uniform writeonly image2D rgba32Float;
layout(set = 0, binding = 5, rgba32ui) uniform writeonly uimage2D rgba32Uint;
layout(set = 0, binding = 6, r16f) uniform writeonly image2D r16Float;
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D rgba16Float;
layout(set = 0, binding = 8, rgba8) uniform writeonly image2D rgba8Unorm;

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(r32Float)))) return;
    const vec4 value = vec4(pixel, 0.25, -1.5);
    const uvec4 whole = uvec4(pixel, 4000000000u, 7u);
    imageStore(r32Float, pixel, value);
    imageStore(r32Uint, pixel, whole);
    imageStore(rg32Float, pixel, value);
    imageStore(rg32Uint, pixel, whole);
    imageStore(rgba32Float, pixel, value);
    imageStore(rgba32Uint, pixel, whole);
    imageStore(r16Float, pixel, value);
    imageStore(rgba16Float, pixel, value);
    imageStore(rgba8Unorm, pixel, vec4(float(pixel.x) / 255.0, 1.0, 0.0, 2.0));
}
