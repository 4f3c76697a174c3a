// Parameters of SVGF's passes. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_SVGF_PARAMS_H
#define LIMPID_DENOISE_SVGF_PARAMS_H

#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

LIMPID_CONST int SVGF_TILE = 8;  // pixels along an edge
// Pixels one below the other, a step apart, that an invocation of a level filters. Rows of invocations are
// rows of pixels, whole cache lines at any step; with more pixels there is room for too few invocations.
LIMPID_CONST int SVGF_COLUMN = 3;
// In place of a deviation.
LIMPID_CONST float SVGF_NOTHING_SEEN = -1.0;
LIMPID_CONST float SVGF_STILL_YOUNG = -2.0;  // until it is estimated in space
LIMPID_CONST float SVGF_YOUNG = 4.0;       // frames of history below which the variance is estimated in space
LIMPID_CONST float SVGF_MIN_FRAMES = 1.5;  // of history: 2 is the first, but for rounding
LIMPID_CONST float SVGF_MIN_LAG = 0.1;     // less would change little, and cost as much memory traffic
LIMPID_CONST float SVGF_MIN_SLOPE =
    0.05;  // cosine: surfaces seen at a more grazing angle have this one's slope
LIMPID_CONST float SVGF_DEPTH_FLOOR = 1e-3;  // of the distance: tolerated where a surface faces the viewer
LIMPID_CONST float SVGF_LUMINANCE_FLOOR = 1e-3;  // of the luminance: tolerated where there is no noise

struct SvgfSizeParams {
    uint width;
    uint height;
};

/// What tiles make of moments.
struct SvgfLagParams {
    float steadyShare;  // of the samples' variance that fast minus slow mean has
    float antilag;
    float antilagNoise;  // deviations of a tile that are no lag
    float antilagPixel;  // deviations that one pixel may say
};

struct SvgfReprojectParams {
    CameraParams camera;
    uint width;
    uint height;
    float normalTest;  // cosine
    float depthTest;
    uint relative;  // 0: depthTest is in world units
    uint search;
    uint demodulate;
    float alpha;
    float alphaMoments;
    float alphaFast;
    float longest;             // frames
    float stabilisationAlpha;  // 1 if there is no stable light of before
    SvgfLagParams lag;
};

struct SvgfTilesParams {
    uint width;
    uint height;
    SvgfLagParams lag;
};

struct SvgfAntilagParams {
    uint width;
    uint height;
    uint demodulate;
    float alpha;
    float alphaMoments;
    float alphaFast;
};

struct SvgfFilterParams {
    CameraParams camera;
    uint width;
    uint height;
    int step;  // pixels
    float phiColor;
    float normalScale;         // log2(e) phi_normal; with positions log2(e) / phi_normal
    float depthScale;          // log2(e) / phi_depth
    float stabilisationNoise;  // deviations that the stable light of before may differ by
};

struct SvgfModulateParams {
    uint width;
    uint height;
    uint demodulate;
};

#ifndef __cplusplus
/// What a deviation is multiplied by: the longer the history, the less noise its mean has.
float svgfBoost(bool boost, float frames) {
    return boost ? 2.0 * inversesqrt(max(frames, 1.0)) : 1.0;
}
#endif

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
