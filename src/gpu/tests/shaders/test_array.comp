// Rejected by reflection: array of images.
#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, r32f) uniform writeonly image2D results[2];

void main() {
    imageStore(results[1], ivec2(0), vec4(1.0));
}
