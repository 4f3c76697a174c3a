// Rejected by reflection: push constants.
#version 460
layout(local_size_x = 1) in;
layout(push_constant) uniform Push {
    float value;
} push;
layout(set = 0, binding = 0, r32f) uniform writeonly image2D result;

void main() {
    imageStore(result, ivec2(0), vec4(push.value));
}
