// Reads texel buffers and a storage buffer, writes a storage buffer and counts in another.
#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly imageBuffer texels;
layout(set = 0, binding = 1, r32ui) uniform readonly uimageBuffer indices;
layout(set = 0, binding = 2, scalar) readonly buffer Offsets {
    float values[];
} offsets;
layout(set = 0, binding = 3, scalar) buffer Counter {
    uint count;
} counter;
layout(set = 0, binding = 4, scalar) writeonly buffer Sums {
    float sums[];
};

void main() {
    const int i = int(gl_GlobalInvocationID.x);
    if (i >= imageSize(indices)) return;
    const vec4 texel = imageLoad(texels, int(imageLoad(indices, i).x));
    sums[i] = texel.x + texel.y + texel.z + texel.w + offsets.values[i];
    atomicAdd(counter.count, 1);
}
