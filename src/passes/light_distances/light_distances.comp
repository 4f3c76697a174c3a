#version 460
#extension GL_EXT_scalar_block_layout : require
// From what light_first_hits.glsl has found: up to where each texel's direction is open, by its own rays, and by those
// of its neighbours on the sphere, too.
#include "passes/light_distances/light_distances_params.h"
#include "shaders/common/distance_pair.glsl"

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

/// Up to where the direction of a texel is open by its own rays.
float openUpTo(float nearest, float farthest) {
    const float differ = farthest - nearest;
    return farthest + clamp(differ, farthest * LIGHT_MAP_LEAST_MARGIN, farthest * LIGHT_MAP_GREATEST_MARGIN);
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
            farthest = max(farthest, upperDistance(imageLoad(lightFirstHits, first + at.y * SIZE + at.x).x));
        }
    }
    const int at = first + place.x + texel.y * SIZE;
    const float hits = imageLoad(lightFirstHits, at).x;
    const float around = farthest * (1.0 + LIGHT_MAP_MARGIN_AROUND);
    const float own = min(openUpTo(lowerDistance(hits), upperDistance(hits)), around);
    imageStore(lightDistances, at, vec4(packDistances(own, around)));
}
