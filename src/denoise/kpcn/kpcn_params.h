// Parameters of the kernel-predicting network's passes. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_KPCN_PARAMS_H
#define LIMPID_DENOISE_KPCN_PARAMS_H

#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#endif

/// A pixel's channels lie in slabs of 16 (docs/kpcn.md, "On the device").
const uint KPCN_SLAB = 16u;
/// Taps of a convolution along each axis.
const uint KPCN_TAPS = 5u;
/// Input channels per pixel. One more channel is always 1; its weights are the bias.
const uint KPCN_INPUT_CHANNELS = 34u;
const uint KPCN_INPUT_SLABS = 3u;
/// Added to albedo before light is divided by it.
const float KPCN_EPSILON = 0.00316f;

/// For the filter levels after the kernels: when a neighbour counts as another surface.
const float KPCN_LEVEL_NORMAL = 64.0f;  // sharpness of the comparison of normals
const float KPCN_LEVEL_DEPTH = 0.005f;  // tolerated difference of distance, relative
const float KPCN_LEVEL_ALBEDO = 0.05f;  // tolerated difference of albedo, per component

/// The region that a pass computes, in pixels of the picture.
struct KpcnRegion {
    int left, top;         // the first pixel to compute
    int width, height;     // size of the region to compute
    int originX, originY;  // first pixel that the buffers contain
    int pitch, rows;       // size of the buffers
    int pictureWidth, pictureHeight;
};

struct KpcnFeaturesParams {
    KpcnRegion region;
    float ofMean;      // converts mean squared deviation to variance of the mean: 1 / (samples - 1); 0 for
                       // one sample
    uint specular;     // which side
    uint logarithmic;  // whether the network sees log(1 + light); if 0, the light itself
};

struct KpcnLayerParams {
    KpcnRegion region;
    uint inputSlabs;   // slabs of the previous layer
    uint outputTiles;  // slabs of this layer
    uint weights;      // offset in the buffer, in units of 8
    uint kernelWidth;  // last layer only: pixels
    float facing;      // last layer only: KpcnWeights::facing
};

struct KpcnReduceParams {
    int width, height;  // size of the source
};

struct KpcnLevelParams {
    int width, height;
    int step;        // pixels
    float phiColor;  // tolerated difference of luminance, deviations
    uint specular;   // which side
};

struct KpcnLimitParams {
    int width, height;
    float ofMean;          // as in KpcnFeaturesParams
    float standardErrors;  // maximum deviation of clean from noisy luminance; 0: no limit
};

#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
