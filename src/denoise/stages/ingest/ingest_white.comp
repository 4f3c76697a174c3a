#version 460
#extension GL_EXT_scalar_block_layout : require
// The albedo of a caller who has none, one pixel for all: light is then not demodulated.
layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    uvec2 extent;
};
layout(set = 0, binding = 1, rgba8) uniform writeonly image2D white;

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= extent.x || pixel.y >= extent.y) return;
    imageStore(white, ivec2(pixel), vec4(1.0));
}
