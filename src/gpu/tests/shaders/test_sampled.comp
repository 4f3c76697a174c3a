// Rejected by reflection: sampled image.
#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform sampler2D picture;
layout(set = 0, binding = 1, r32f) uniform writeonly image2D result;

void main() {
    imageStore(result, ivec2(0), textureLod(picture, vec2(0.5), 0.0));
}
