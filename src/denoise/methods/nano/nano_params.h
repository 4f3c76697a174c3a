// Parameters and sizes of the passes of `nano`. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_NANO_PARAMS_H
#define LIMPID_DENOISE_NANO_PARAMS_H

#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

LIMPID_CONST int NANO_LEVELS = 5;     // resolutions; each halves the one before
LIMPID_CONST int NANO_FEATURES = 24;  // that the network sees of a pixel
LIMPID_CONST int NANO_GROUP = 8;      // channels in a texel of a buffer, as halves
LIMPID_CONST int NANO_PIXELS = 4;     // in a row, that one invocation of a convolution computes
// The same of features and filters where filters read images, as on CPUs: pixels share the loads of weights
// there. It divides 2^(NANO_LEVELS - 1).
LIMPID_CONST int NANO_IMAGE_PIXELS = 4;
LIMPID_CONST uint NANO_WEIGHTS_WIDTH = 1024u;  // texels in a row of the weights, if they are an image
// A workgroup of a convolution on cooperative matrices: columns of pixels, and subgroups.
LIMPID_CONST uint NANO_COLUMNS = 16u, NANO_SUBGROUPS = 8u, NANO_SMALL_SUBGROUPS = 4u;
// The filter: a pixel has (2 reach + 1)^2 taps of its level and NANO_COARSER_TAPS of the next coarser one. A
// signal's logits are those of the taps; at the finest level those of the filter's share and of SVGF's; and,
// but at the coarsest level, that of the pixel in the next coarser level. They fill so many groups.
LIMPID_CONST int NANO_REACH = 1, NANO_FINEST_REACH = 2;
LIMPID_CONST int NANO_COARSER_TAPS = 4;
LIMPID_CONST int NANO_LOGIT_GROUPS = 2, NANO_FINEST_LOGIT_GROUPS = 4;
// Logits of both signals at the finest level, and most channels that they are made from.
LIMPID_CONST int NANO_FINEST_LOGITS = 2 * NANO_FINEST_LOGIT_GROUPS * NANO_GROUP, NANO_MOST_FINEST = 48;
// Taps of a convolution.
LIMPID_CONST uint NANO_POINT = 0u;   // 1x1: of the same pixel, then of the pixel of the next coarser level
LIMPID_CONST uint NANO_HALVE = 1u;   // 2x2: of the four pixels of the next finer level
LIMPID_CONST uint NANO_AROUND = 2u;  // 3x3: of the pixels around; 0 beyond the edges

struct NanoFeaturesParams {
    CameraParams camera;
    uint width;  // of the picture
    uint height;
    uint tileX;  // the tile's corner in the picture
    uint tileY;
    uint paddedWidth;  // of the tile: a multiple of 2^(NANO_LEVELS - 1)
    uint paddedHeight;
};

struct NanoConvolveParams {
    uint width;  // of the outputs
    uint height;
    uint groups;         // of inputs
    uint coarserGroups;  // of inputs of the next coarser level
    uint outputGroups;
    uint weights;  // index of the layer's first texel
};

struct NanoFilterParams {
    uint width;  // of what is written: the tile's inner part at the finest level, else the padded level
    uint height;
    uint innerX;  // the corner of what is written at the finest level, in the picture
    uint innerY;
    uint tileX;  // the tile's corner in the picture, for the finest level
    uint tileY;
    uint paddedWidth;
    uint paddedHeight;
    uint groups;       // of inputs
    uint logitGroups;  // of each signal
    uint weights;      // index of the layer's first texel
    float strength;
};

// The finest level's, with the weights of its logits. Invocations read the same ones at the same time, for
// which uniform blocks are made, and need not convert them from halves.
struct NanoFinestParams {
    NanoFilterParams level;
    float logits[(1 + NANO_MOST_FINEST) * NANO_FINEST_LOGITS];  // biases, then the weights of each input
};

struct NanoMixParams {
    uint width;  // of the tile's inner part
    uint height;
    uint innerX;  // its corner in the picture
    uint innerY;
    uint pitch;  // pixels in a row of the light
    float strength;
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
