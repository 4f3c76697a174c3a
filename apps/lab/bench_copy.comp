#version 460
// Copies an image, to measure the device's maximum memory bandwidth.
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D source;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D result;

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, imageSize(source)))) imageStore(result, at, imageLoad(source, at));
}
