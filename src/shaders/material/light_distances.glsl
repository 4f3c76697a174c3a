// Whether a punctual light is hidden from a point, from a map of distances around the light
// (passes/light_distances). docs/lighting.md describes what follows for the sampling probabilities.
#ifndef LIMPID_LIGHT_DISTANCES_GLSL
#define LIMPID_LIGHT_DISTANCES_GLSL

#include "shaders/common/distance_pair.glsl"
#include "shaders/common/sampling.glsl"
#include "shaders/common/scene_data.glsl"

/// Factors of the weights of lights that are hidden by their maps, if chosen by usable light, and uniformly. They are
/// above 0, since a map can miss a narrow gap. The last one is larger, and bounds the noise where a map is wrong.
const float HIDDEN_WEIGHT = 0.001;  // almost surely hidden
const float PROBABLY_HIDDEN_WEIGHT = 0.01;
const float HIDDEN_UNIFORM_WEIGHT = 0.05;  // almost surely hidden

/// The texel for a direction that leaves the light.
ivec2 lightMapTexel(vec3 direction) {
    const float size = float(LIGHT_MAP_SIZE);
    const vec2 place = (0.5 + 0.5 * octahedralOf(direction)) * size;
    return ivec2(clamp(place, vec2(0.0), vec2(size - 1.0)));
}

struct Hidden {
    bool probably, surely;
};

/// The factor of the weight by usable light.
float weightFactor(Hidden hidden) {
    if (hidden.surely) return HIDDEN_WEIGHT;
    return hidden.probably ? PROBABLY_HIDDEN_WEIGHT : 1.0;
}

/// `map`: number of the punctual light. `direction` and `distance` are those from the point to the light.
Hidden hiddenByMap(uint map, vec3 direction, float distance) {
    if (map >= LIGHT_MAPS) return Hidden(false, false);
    const ivec2 texel = lightMapTexel(-direction);
    const int at = int((map * LIGHT_MAP_SIZE + uint(texel.y)) * LIGHT_MAP_SIZE) + texel.x;
    const float both = imageLoad(lightDistances, at).x;
    return Hidden(distance > lowerDistance(both), distance > upperDistance(both));
}

#endif
