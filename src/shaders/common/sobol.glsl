// Owen-scrambled Sobol' points for a pixel's samples, whose error is blue noise on screen. C++ copy for tests:
// tests/reference/sobol_copy.h.
//
// Each draw (one or two dimensions) has two points of its own, combined by exclusive or:
//
// - that of the sample's number: the first two dimensions of I. M. Sobol's sequence (the directions of S. Joe, F. Y.
//   Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 2008), in an
//   order shuffled for each draw, Owen-scrambled (B. Burley, "Practical hash-based Owen scrambling", JCGT 2020). It is
//   the same in all pixels, so any 2^k consecutive samples that begin at a multiple of 2^k are a (0, k, 2)-net.
// - that of the pixel: the same sequence, taken in an order of the pixels that keeps squares of 2^k x 2^k together,
//   shuffled for each draw: A. G. M. Ahmed, P. Wonka, "Screen-space blue-noise diffusion of Monte Carlo sampling error
//   via hierarchical ordering of pixels", ACM TOG 2020. Their sampler gives each pixel a run of the sequence, which
//   needs the final number of samples and is blue noise only then. As a digital shift, it leaves a pixel's points a
//   net, and every single sample of all pixels is blue noise.
#ifndef LIMPID_SOBOL_GLSL
#define LIMPID_SOBOL_GLSL

/// What the draws of a sample depend on.
struct SobolSample {
    uint number;  // bits reversed
    uint pixel;   // Morton code, bits reversed: x of the finest level is the highest bit
    uint key;     // of the seed
    uint draw;    // number of the next draw
};

/// Returns a permutation of all words, chosen by `key`, in which each bit depends on the lower ones only. On reversed
/// bits it is Owen's scrambling. N. Vegdahl, "Building a better LK hash", 2021, after S. Laine, T. Karras, "Stratified
/// sampling for stochastic transparency", EGSR 2011.
uint scrambleUpwards(uint x, uint key) {
    x ^= x * 0x3d20adeau;
    x += key;
    x *= (key >> 16) | 1u;
    x ^= x * 0x05526c56u;
    return x ^ (x * 0x53a22864u);
}

/// Returns the second dimension of Sobol's sequence at `index`, bits reversed; that of the first is `index`. Its
/// matrix is Pascal's triangle modulo 2: the sum over all supersets of a bit's position.
uint secondSobol(uint index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    return index ^ (index >> 16);
}

/// Returns a hash; the output function of PCG (rng.glsl).
uint sobolHash(uint x) {
    x = x * 747796405u + 2891336453u;
    const uint word = ((x >> ((x >> 28) + 4u)) ^ x) * 277803737u;
    return (word >> 22) ^ word;
}

/// Puts a zero between the lower 16 bits.
uint spreadBits(uint x) {
    x = (x | (x << 8)) & 0x00ff00ffu;
    x = (x | (x << 4)) & 0x0f0f0f0fu;
    x = (x | (x << 2)) & 0x33333333u;
    return (x | (x << 1)) & 0x55555555u;
}

/// Sample `number` of a pixel; coordinates below 65,536.
SobolSample startSobol(uvec2 pixel, uint number, uint seed) {
    const uint morton = spreadBits(pixel.x & 0xffffu) | (spreadBits(pixel.y & 0xffffu) << 1);
    return SobolSample(bitfieldReverse(number), bitfieldReverse(morton), sobolHash(seed), 0u);
}

/// The indices of a draw's two points, and the draw's key.
struct SobolDraw {
    uint number, pixel, key;
};

/// A square's two halves, split first, take alternate points: for each draw they are upper and lower, left and right,
/// or the diagonals. So no direction is preferred.
SobolDraw nextDraw(inout SobolSample at) {
    const uint key = sobolHash(at.key + at.draw);
    ++at.draw;
    const uint coarse = at.pixel & 0x55555555u, fine = (at.pixel >> 1) & 0x55555555u;
    uint pixel = at.pixel;
    const uint split = ((key >> 16) * 3u) >> 16;
    if (split == 1u) pixel = (coarse << 1) | fine;
    if (split == 2u) pixel = at.pixel ^ fine;
    return SobolDraw(bitfieldReverse(scrambleUpwards(at.number, key)),
                     bitfieldReverse(scrambleUpwards(pixel, key * 0x9e3779b1u)), key);
}

/// Combines two points, given with reversed bits, to a number in [0, 1), a multiple of 2^-24.
float combined(uint ofNumber, uint numberKey, uint ofPixel, uint pixelKey) {
    const uint reversed = scrambleUpwards(ofNumber, numberKey) ^ scrambleUpwards(ofPixel, pixelKey);
    return float(bitfieldReverse(reversed) >> 8) / float(0x01000000);
}

float nextSobol(inout SobolSample at) {
    const SobolDraw draw = nextDraw(at);
    return combined(draw.number, draw.key * 0x85ebca77u, draw.pixel, draw.key * 0xc2b2ae3du);
}

vec2 nextSobol2(inout SobolSample at) {
    const SobolDraw draw = nextDraw(at);
    return vec2(combined(draw.number, draw.key * 0x85ebca77u, draw.pixel, draw.key * 0xc2b2ae3du),
                combined(secondSobol(draw.number), draw.key * 0x27d4eb2fu, secondSobol(draw.pixel),
                         draw.key * 0x165667b1u));
}

#endif
