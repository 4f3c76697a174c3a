#version 460
#extension GL_EXT_scalar_block_layout : require
// The weight of a child of the light tree, the probability of a trail, and a walk from the root, for one point each.
#include "shaders/material/light_tree.glsl"

layout(local_size_x = 64) in;

struct Query {
    vec3 position, normal;
    float grazing;
    uint bothSides, child, seed;
    uvec4 trail;
};
struct Answer {
    float weight, probability;
    uint light;
    float chosenProbability, left;
};

layout(set = 0, binding = 20, scalar) uniform Params {
    uint count;
} params;
layout(set = 0, binding = 21, scalar) readonly buffer Queries {
    Query values[];
} queries;
layout(set = 0, binding = 22, scalar) writeonly buffer Results {
    Answer values[];
} results;

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= params.count) return;
    const Query q = queries.values[i];
    const Receiver from = Receiver(q.position, q.normal, q.normal, q.bothSides != 0u, q.grazing);
    uint rng = startStream(i, 0u, q.seed);
    const int at = int(q.child * LIGHT_CHILD_TEXELS);
    const uint noMaps = 0x7FFFFFFFu;
    float u = random(rng);
    const ChosenLight chosen = chooseFromLightTree(from, noMaps, u, rng);
    results.values[i] = Answer(lightWeight(from, imageLoad(lightTree, at), imageLoad(lightTree, at + 1)),
                               lightTreeProbability(from, noMaps, q.trail), chosen.light, chosen.probability, u);
}
