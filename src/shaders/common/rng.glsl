// Random numbers: one stream per pixel and frame, and for most decisions of a path, with `sobol`, points that are
// spread evenly over a pixel's samples and over neighbouring pixels (sobol.glsl).
//
// Seed: 16 rounds of the Tiny Encryption Algorithm; F. Zafar, M. Olano, A. Curtis, "GPU random numbers via the Tiny
// Encryption Algorithm", HPG 2010. Streams: `tea` continues with the low 24 bits of Numerical Recipes' linear
// congruential generator (as in many Vulkan tutorials; its low bits are poor, it is kept for comparison); `pcg` with
// the RXS-M-XS output of M. E. O'Neill, "PCG: a family of simple fast space-efficient statistically good algorithms
// for random number generation", 2014. C++ copy for tests: tests/reference/rng_copy.h.
#ifndef LIMPID_RNG_GLSL
#define LIMPID_RNG_GLSL

#include "shaders/common/sampler.h"
#ifdef SOBOL_TABLE
#include "shaders/common/sobol.glsl"
#endif

layout(constant_id = 20) const uint SAMPLER = SAMPLER_PCG;

uint tea(uint v0, uint v1) {
    uint sum = 0u;
    for (uint round = 0u; round < 16u; ++round) {
        sum += 0x9e3779b9u;
        v0 += ((v1 << 4) + 0xa341316cu) ^ (v1 + sum) ^ ((v1 >> 5) + 0xc8013ea4u);
        v1 += ((v0 << 4) + 0xad90777du) ^ (v0 + sum) ^ ((v0 >> 5) + 0x7e95761eu);
    }
    return v0;
}

/// Returns the stream of a pixel in a frame; `seed` 0 gives the default one.
uint startStream(uint pixel, uint frame, uint seed) {
    return tea(pixel, frame ^ (seed * 0x9e3779b9u));
}

uint pcgOutput(uint state) {
    const uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

/// Returns a uniform number in [0, 1), a multiple of 2^-24.
float random(inout uint state) {
    if (SAMPLER == SAMPLER_TEA) {
        state = 1664525u * state + 1013904223u;
        return float(state & 0x00ffffffu) / float(0x01000000);
    }
    const uint result = pcgOutput(state);
    state = state * 747796405u + 2891336453u;
    return float(result >> 8) / float(0x01000000);
}

/// Returns a number that depends on the state and two more values, without changing the state.
float randomOf(uint state, uint a, uint b) {
    const uint mixed = pcgOutput(state ^ pcgOutput(a * 747796405u + 2891336453u) ^ (b * 277803737u));
    return float(pcgOutput(mixed * 747796405u + 2891336453u) >> 8) / float(0x01000000);
}

vec2 random2(inout uint state) {
    const float x = random(state);
    return vec2(x, random(state));
}

#ifdef SOBOL_TABLE
SobolSample sobolSample;

/// Must come before the first stratified() of each sample. `index`: of the pixel's sample in this launch.
void startSample(uvec2 pixel, uint index) {
    if (SAMPLER == SAMPLER_SOBOL) sobolSample = startSobol(pixel, index);
}
#endif

/// Like random(), for decisions on which a path's light depends much: with `sobol`, the numbers that a pixel's samples
/// and its neighbours get from calls with the same place in the order of all calls are spread evenly. Each call of a
/// sample is independent of all others. Only shaders that define SOBOL_TABLE know `sobol`, and calls beyond the table
/// give independent numbers.
float stratified(inout uint state) {
#ifdef SOBOL_TABLE
    if (SAMPLER == SAMPLER_SOBOL && hasDraw(sobolSample)) return nextSobol(sobolSample);
#endif
    return random(state);
}

/// Like stratified(), in both dimensions together.
vec2 stratified2(inout uint state) {
#ifdef SOBOL_TABLE
    if (SAMPLER == SAMPLER_SOBOL && hasDraw(sobolSample)) return nextSobol2(sobolSample);
#endif
    return random2(state);
}

/// True if a choice and a point for what was chosen should share a number: the points for each of the choices are then
/// spread evenly, too. Independent numbers gain nothing by it. (Walks through the light tree share always, since a new
/// number for each node would take as long.)
bool sharesNumbers() {
    return SAMPLER == SAMPLER_SOBOL;
}

/// Returns the place of a number in the interval that it has chosen, from 0 to 1, which is again uniform. `place`: its
/// distance from the beginning, divided by the interval's width; `scale`: the inverse of that width. The digits that
/// the number lacks are random.
float placeWithin(float place, float scale, inout uint state) {
    return clamp(place + random(state) * (scale / float(0x01000000)), 0.0, 1.0 - 1.0 / float(0x01000000));
}

#endif
