// Parameters of the stage that smooths edges of surfaces. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_EDGES_PARAMS_H
#define LIMPID_DENOISE_EDGES_PARAMS_H

#ifdef __cplusplus
#include "base/math.h"
namespace limpid::denoise {
#endif

struct EdgesParams {
    uint width;
    uint height;
    uint reach;  // pixels, along an edge in each direction
};

// Bits of a pixel in the image of edges: between it and the next pixel to the right, and the one below.
const uint EDGE_RIGHT = 1u;
const uint EDGE_BELOW = 2u;

#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
