#include "passes/sobol_points.h"

#include <algorithm>
#include <glm/integer.hpp>

namespace limpid {
namespace {

/// Returns a hash; the output function of PCG (rng.glsl).
uint32_t hashed(uint32_t x) {
    x = x * 747796405u + 2891336453u;
    const uint32_t word = ((x >> ((x >> 28) + 4u)) ^ x) * 277803737u;
    return (word >> 22) ^ word;
}

/// Returns a permutation of all words, chosen by `key`, in which each bit depends on the lower ones only. On
/// reversed bits it is Owen's scrambling. N. Vegdahl, "Building a better LK hash", 2021, after S. Laine, T.
/// Karras, "Stratified sampling for stochastic transparency", EGSR 2011.
uint32_t scrambleUpwards(uint32_t x, uint32_t key) {
    x ^= x * 0x3d20adeau;
    x += key;
    x *= (key >> 16) | 1u;
    x ^= x * 0x05526c56u;
    return x ^ (x * 0x53a22864u);
}

/// Returns the second dimension of Sobol's sequence at `index`, bits reversed; that of the first is `index`.
/// Its matrix is Pascal's triangle modulo 2: the sum over all supersets of a bit's position.
uint32_t secondSobol(uint32_t index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    return index ^ (index >> 16);
}

/// A square's two halves, split first, take alternate points: for each draw they are upper and lower, left
/// and right, or the diagonals. So no direction is preferred.
SobolKeys keysOf(uint32_t key) {
    const uint32_t split = ((key >> 16) * 3u) >> 16;
    return {.factor = hashed(key ^ 0x68e31da4u) | 1u,
            .order = key * 0x9e3779b1u,
            .first = key * 0xc2b2ae3du,
            .second = key * 0x165667b1u,
            .kept = split == 1u ? 0u : 0xffffffffu,
            .moved = split == 0u ? 0u : 0x55555555u};
}

SobolPoint pointOf(uint32_t number, uint32_t key) {
    const uint32_t index = glm::bitfieldReverse(scrambleUpwards(glm::bitfieldReverse(number), key));
    const uint32_t first = scrambleUpwards(index, key * 0x85ebca77u);
    const uint32_t second = scrambleUpwards(secondSobol(index), key * 0x27d4eb2fu);
    return {glm::bitfieldReverse(first) >> 8, glm::bitfieldReverse(second) >> 8};
}

}  // namespace

SobolTable sobolTable(Sampler sampler, uint32_t seed, const SobolSamples& samples) {
    SobolTable table{};
    if (sampler != Sampler::Sobol) return table;
    table.draws = std::min({samples.draws, SOBOL_DRAWS, SOBOL_POINTS / std::max(samples.count, 1u)});
    for (uint32_t draw = 0; draw < table.draws; ++draw) {
        const uint32_t key = hashed(hashed(seed) + draw);
        table.keys[draw] = keysOf(key);
        for (uint32_t i = 0; i < samples.count; ++i)
            table.points[i * table.draws + draw] = pointOf(samples.first + i, key);
    }
    return table;
}

}  // namespace limpid
