// Owen-scrambled Sobol' points for a pixel's samples, whose error is blue noise on screen. C++ copy for tests:
// tests/reference/sobol_copy.h. The including shader defines SOBOL_TABLE, a SobolTable.
//
// Each draw (one or two dimensions) has two points of its own, combined by exclusive or:
//
// - that of the sample's number: the first two dimensions of I. M. Sobol's sequence (the directions of S. Joe, F. Y.
//   Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 2008), in an
//   order shuffled for each draw, Owen-scrambled (B. Burley, "Practical hash-based Owen scrambling", JCGT 2020). It is
//   the same in all pixels, so any 2^k consecutive samples that begin at a multiple of 2^k are a (0, k, 2)-net.
// - that of the pixel, 16 digits: the same sequence, taken in an order of the pixels that keeps squares of 2^k x 2^k
//   together, shuffled for each draw: A. G. M. Ahmed, P. Wonka, "Screen-space blue-noise diffusion of Monte Carlo
//   sampling error via hierarchical ordering of pixels", ACM TOG 2020. Their sampler gives each pixel a run of the
//   sequence, which needs the final number of samples and is blue noise only then. As a digital shift, it leaves a
//   pixel's points a net, and every single sample of all pixels is blue noise.
//
// The first is the same for all pixels, so the host computes it for each launch, with the keys of the second
// (passes/sobol_points.cpp). Only the pixel's own point is left to the shader.
#ifndef LIMPID_SOBOL_GLSL
#define LIMPID_SOBOL_GLSL

#include "shaders/common/sobol_table.h"

/// What the draws of a sample depend on, besides the table.
struct SobolSample {
    uint pixel;   // Morton code, bits reversed: x of the finest level is the highest bit
    uint points;  // place of its points in the table
    uint draw;    // number of the next draw
};

/// Puts a zero between the lower 16 bits.
uint spreadBits(uint x) {
    x = (x | (x << 8)) & 0x00ff00ffu;
    x = (x | (x << 4)) & 0x0f0f0f0fu;
    x = (x | (x << 2)) & 0x33333333u;
    return (x | (x << 1)) & 0x55555555u;
}

/// Sample `index` of the launch; coordinates below 65,536.
SobolSample startSobol(uvec2 pixel, uint index) {
    const uint morton = spreadBits(pixel.x & 0xffffu) | (spreadBits(pixel.y & 0xffffu) << 1);
    return SobolSample(bitfieldReverse(morton), index * SOBOL_TABLE.draws, 0u);
}

/// True if the table has the sample's next draw.
bool hasDraw(SobolSample at) {
    return at.draw < SOBOL_TABLE.draws;
}

/// Returns a permutation of all words in which each bit depends on the lower ones only, like scrambleUpwards() in
/// passes/sobol_points.cpp: one step of a linear congruential generator, and a round of Laine and Karras's hash.
/// That is enough here, since the sample's point scrambles the pixel's once more.
uint scrambleLightly(uint x, uint factor, uint key) {
    x = x * factor + key;
    return x ^ (x * 0x05526c56u);
}

/// Returns the second dimension of Sobol's sequence at the lower 16 bits of `index`: 16 bits, reversed. That of the
/// first is `index`. Its matrix is Pascal's triangle modulo 2: the sum over all supersets of a bit's position.
uint secondSobol(uint index) {
    index ^= (index >> 1) & 0x5555u;
    index ^= (index >> 2) & 0x3333u;
    index ^= (index >> 4) & 0x0f0fu;
    return index ^ ((index >> 8) & 0x00ffu);
}

/// A draw's point of the sample, the keys of the pixel's point, and the place of that one in Sobol's sequence.
struct SobolDraw {
    SobolPoint point;
    SobolKeys keys;
    uint pixel;
};

SobolDraw nextDraw(inout SobolSample at) {
    SobolDraw next;
    next.point = SOBOL_TABLE.points[at.points + at.draw];
    next.keys = SOBOL_TABLE.keys[at.draw];
    ++at.draw;
    const uint ordered = (at.pixel & next.keys.kept) ^ ((at.pixel >> 1) & next.keys.moved) ^
                         ((at.pixel << 1) & ~next.keys.kept & 0xaaaaaaaau);
    next.pixel = bitfieldReverse(scrambleLightly(ordered, next.keys.factor, next.keys.order));
    return next;
}

/// Returns a fraction of 24 bits as a number in [0, 1).
float sobolFloat(uint fraction) {
    return float(fraction) / float(0x01000000);
}

/// Only if hasDraw().
float nextSobol(inout SobolSample at) {
    const SobolDraw next = nextDraw(at);
    const uint ofPixel = bitfieldReverse(scrambleLightly(next.pixel, next.keys.factor, next.keys.first));
    return sobolFloat(next.point.first ^ ((ofPixel >> 8) & 0x00ffff00u));
}

/// Only if hasDraw().
vec2 nextSobol2(inout SobolSample at) {
    const SobolDraw next = nextDraw(at);
    const uint first = scrambleLightly(next.pixel, next.keys.factor, next.keys.first);
    const uint second = scrambleLightly(secondSobol(next.pixel), next.keys.factor, next.keys.second);
    const uint ofPixel = bitfieldReverse((first & 0xffffu) | (second << 16));  // both dimensions at once
    return vec2(sobolFloat(next.point.first ^ ((ofPixel >> 8) & 0x00ffff00u)),
                sobolFloat(next.point.second ^ ((ofPixel << 8) & 0x00ffff00u)));
}

#endif
