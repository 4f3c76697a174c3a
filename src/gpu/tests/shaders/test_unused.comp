// Declares an image that it never uses.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D result;
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D unused;

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(result)))) return;
    imageStore(result, pixel, vec4(1.0));
}
