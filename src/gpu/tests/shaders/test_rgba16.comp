// Rejected by reflection: unlisted format.
#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, rgba16) uniform writeonly image2D result;

void main() {
    imageStore(result, ivec2(0), vec4(1.0));
}
