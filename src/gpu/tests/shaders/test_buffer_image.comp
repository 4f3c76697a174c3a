// Doubles an image of half4 texels stored in a buffer; writes a buffer and an image.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, scalar) readonly buffer Source {
    uvec2 texels[];
} source;
layout(set = 0, binding = 1, scalar) writeonly buffer Result {
    uvec2 texels[];
} result;
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2D copied;

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(copied);
    if (any(greaterThanEqual(pixel, size))) return;
    const int i = pixel.y * size.x + pixel.x;
    const uvec2 texel = source.texels[i];
    const vec4 value = 2.0 * vec4(unpackHalf2x16(texel.x), unpackHalf2x16(texel.y));
    result.texels[i] = uvec2(packHalf2x16(value.xy), packHalf2x16(value.zw));
    imageStore(copied, pixel, value);
}
