// Fills an image with a colour plus the pixel's position.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D result;
layout(set = 0, binding = 1, scalar) uniform Params {
    vec3 color;
    float step;
    vec3 tail;
} params;

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(result)))) return;
    imageStore(result, pixel, vec4(params.color + params.tail, params.step * float(pixel.x + 100 * pixel.y)));
}
