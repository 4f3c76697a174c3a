// Parameters of the kernel-predicting network's passes. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_KPCN_PARAMS_H
#define LIMPID_DENOISE_KPCN_PARAMS_H

#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#endif

/// A pixel's channels lie in slabs of 16 (docs/kpcn.md, "On the device").
const uint KPCN_SLAB = 16u;
/// Of a convolution, along each axis.
const uint KPCN_TAPS = 5u;
/// What a network sees of a pixel; one channel more is always 1 and brings the bias.
const uint KPCN_INPUT_CHANNELS = 34u;
const uint KPCN_INPUT_SLABS = 3u;
/// Added to albedo before light is divided by it.
const float KPCN_EPSILON = 0.00316f;

/// Of the levels after the kernels: what is another surface.
const float KPCN_LEVEL_NORMAL = 64.0f;  // sharpness of the tolerance of normals
const float KPCN_LEVEL_DEPTH = 0.005f;  // tolerated difference of distance, of the distance
const float KPCN_LEVEL_ALBEDO = 0.05f;  // ... and of albedo, component by component

/// Where a pass works. Pixels are those of the picture.
struct KpcnRegion {
    int left, top;         // the first pixel to compute
    int width, height;     // of what is computed
    int originX, originY;  // the first pixel of the buffers
    int pitch, rows;       // of the buffers
    int pictureWidth, pictureHeight;
};

struct KpcnFeaturesParams {
    KpcnRegion region;
    float ofMean;   // from mean squared deviations to variances of means: 1 / (samples - 1), 0 for one sample
    uint specular;  // which side
};

struct KpcnLayerParams {
    KpcnRegion region;
    uint inputSlabs;   // of the layer before
    uint outputTiles;  // slabs of this one
    uint weights;      // where they begin in the buffer, by 8
    uint kernelWidth;  // of the last layer: pixels
    float facing;      // of the last layer: KpcnWeights::facing
};

struct KpcnReduceParams {
    int width, height;  // of the source
};

struct KpcnLevelParams {
    int width, height;
    int step;        // pixels
    float phiColor;  // deviations that luminances may differ by
    uint specular;   // which side
};

struct KpcnComposeParams {
    int width, height;
    float ofMean;          // as in KpcnFeaturesParams
    float standardErrors;  // how far clean luminance may be from the noisy one; 0: as far as it likes
};

#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
