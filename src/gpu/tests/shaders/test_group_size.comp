// A workgroup size set by specialisation constants. The defaults appear twice, since GLSL gives the size its
// own constant.
#version 460
layout(local_size_x = 8, local_size_y = 4, local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 0) const uint groupWidth = 8;
layout(constant_id = 1) const uint groupHeight = 4;
layout(set = 0, binding = 0, rg32ui) uniform writeonly uimage2D result;

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(result)))) return;
    imageStore(result, pixel, uvec4(gl_WorkGroupSize.x, groupHeight, 0, 0));
}
