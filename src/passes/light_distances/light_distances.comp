#version 460
#extension GL_EXT_scalar_block_layout : require
// From what light_first_hits.glsl has found: the farthest of each texel; and of each texel and its neighbours on the
// sphere, and a margin.
#include "passes/light_distances/light_distances_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    LightDistancesParams params;
};
layout(set = 0, binding = 1, r32f) uniform readonly imageBuffer lightFirstHits;
layout(set = 0, binding = 2, r32f) uniform writeonly imageBuffer lightDistances;

const int SIZE = int(LIGHT_MAP_SIZE);

/// Beyond an edge, an octahedral map goes on at the same edge, mirrored about its middle.
ivec2 wrapped(ivec2 texel) {
    if (texel.x < 0 || texel.x >= SIZE) texel = ivec2(clamp(texel.x, 0, SIZE - 1), SIZE - 1 - texel.y);
    if (texel.y < 0 || texel.y >= SIZE) texel = ivec2(SIZE - 1 - texel.x, clamp(texel.y, 0, SIZE - 1));
    return texel;
}

/// The upper half of the least float with 16 bits that is not below the distance.
uint halfAbove(float distance) {
    return (floatBitsToUint(distance) + 0xFFFFu) >> 16;
}

void main() {
    const ivec2 place = ivec2(gl_GlobalInvocationID.xy);
    const int map = place.y / SIZE, first = map * SIZE * SIZE;
    if (map >= int(params.maps)) return;
    const ivec2 texel = ivec2(place.x, place.y % SIZE);
    float farthest = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            const ivec2 at = wrapped(texel + ivec2(x, y));
            farthest = max(farthest, imageLoad(lightFirstHits, first + at.y * SIZE + at.x).x);
        }
    }
    const int at = first + place.x + texel.y * SIZE;
    const uint own = halfAbove(imageLoad(lightFirstHits, at).x * LIGHT_MAP_MARGIN), around = halfAbove(farthest * LIGHT_MAP_MARGIN);
    imageStore(lightDistances, at, vec4(uintBitsToFloat(around << 16 | own)));
}
