// Rejected by reflection: two uniform blocks.
#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, r32f) uniform writeonly image2D result;
layout(set = 0, binding = 1) uniform A {
    float a;
};
layout(set = 0, binding = 2) uniform B {
    float b;
};

void main() {
    imageStore(result, ivec2(0), vec4(a + b));
}
