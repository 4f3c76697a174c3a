// The parts of Sobol' points (sobol.glsl) that all pixels share: a table for one launch, which the host fills
// (passes/sobol_points.h). Included by C++ and GLSL.
#ifndef LIMPID_SHADERS_SOBOL_TABLE_H
#define LIMPID_SHADERS_SOBOL_TABLE_H

#ifdef __cplusplus
#include "base/math.h"
namespace limpid {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

/// Draws of a sample in the table, at most. A bounce draws two points; six with every material and the light
/// tree.
LIMPID_CONST uint SOBOL_DRAWS = 64u;
/// Points in the table: those of all draws for 16 samples. The uniform block must stay below 16 KiB.
LIMPID_CONST uint SOBOL_POINTS = 1024u;

/// How one draw shuffles and scrambles the points of pixels.
struct SobolKeys {
    uint factor;                // of all three: odd
    uint order, first, second;  // of the order of pixels, and of each dimension
    uint kept, moved;           // bits of the pixel's code that stay, and that come from their left neighbour
};

/// Point of a sample's number: fractions of 24 bits.
struct SobolPoint {
    uint first, second;
};

/// For other samplers, all zero.
struct SobolTable {
    SobolKeys keys[SOBOL_DRAWS];
    SobolPoint points[SOBOL_POINTS];  // of sample i, draw d of the launch: i * draws + d
    uint draws;                       // of each sample; later ones have independent numbers
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid
#endif
#endif
