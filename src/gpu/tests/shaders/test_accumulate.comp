// Counts frames with a history. An invalid history must read as zero; any other value becomes visible as
// thousands.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, r32f) uniform readonly image2D previous;
layout(set = 0, binding = 1, r32f) uniform writeonly image2D current;
layout(set = 0, binding = 2, scalar) uniform Params {
    uint valid;
} params;

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(current)))) return;
    const float before = imageLoad(previous, pixel).x;
    imageStore(current, pixel, vec4(params.valid != 0 ? before + 1.0 : 1.0 + 1000.0 * before));
}
