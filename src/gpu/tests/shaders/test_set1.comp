// Rejected by reflection: descriptor set 1.
#version 460
layout(local_size_x = 1) in;
layout(set = 1, binding = 0, r32f) uniform writeonly image2D result;

void main() {
    imageStore(result, ivec2(0), vec4(1.0));
}
