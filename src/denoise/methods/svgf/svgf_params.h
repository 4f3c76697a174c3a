// Parameters of SVGF's passes. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_SVGF_PARAMS_H
#define LIMPID_DENOISE_SVGF_PARAMS_H

#include "denoise/stages/reproject/reproject_params.h"
#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

LIMPID_CONST int SVGF_TILE = 8;         // pixels along an edge
LIMPID_CONST int SVGF_YOUNG_TILE = 16;  // pixels along an edge of the squares whose young pixels are counted
// Number of pixels in a column, a step apart, that one invocation of a level filters. A row of invocations
// filters a row of pixels, so it reads whole cache lines at any step. More pixels per invocation leave too
// few invocations in flight.
LIMPID_CONST int SVGF_COLUMN = 3;
// Special values in place of a deviation.
LIMPID_CONST float SVGF_NOTHING_SEEN = -1.0;
LIMPID_CONST float SVGF_STILL_YOUNG = -2.0;  // until it is estimated in space
LIMPID_CONST float SVGF_YOUNG = 4.0;       // frames of history below which the variance is estimated in space
LIMPID_CONST float SVGF_MIN_FRAMES = 1.5;  // length of history; 2 is the first, minus rounding
// The length of a history that anti-lag has shortened to one frame. Elsewhere it counts as 1, but stabilised
// light stays, as it does not where there was no history.
LIMPID_CONST float SVGF_SHORTENED = 0.998046875;
LIMPID_CONST float SVGF_MIN_LAG = 0.1;       // smaller lags change little and cost as much memory traffic
LIMPID_CONST float SVGF_MIN_SLOPE = 0.05;    // minimum cosine: more grazing angles use the slope of this one
LIMPID_CONST float SVGF_DEPTH_FLOOR = 1e-3;  // minimum tolerance, relative to the distance
LIMPID_CONST float SVGF_MIN_WEIGHTS = 1e-3;  // sums of weights below which neighbours show other surfaces
// How many equal weights those of neighbours must amount to before a firefly is dimmed by them: (their sum)^2
// / (sum of their squares). One neighbour gives 1, and has no deviation; two alike give 2.
LIMPID_CONST float SVGF_MIN_ALIKE = 1.5;
LIMPID_CONST float SVGF_LUMINANCE_FLOOR = 1e-3;  // minimum tolerance, relative to the luminance

/// How tiles interpret the moments.
struct SvgfLagParams {
    float steadyShare;  // variance of (fast mean - slow mean) / variance of the samples
    float antilag;
    float antilagNoise;  // deviations of a tile that count as noise
    float antilagPixel;  // maximum contribution of one pixel, in deviations
};

struct SvgfReprojectParams {
    CameraParams camera;
    uint width;
    uint height;
    ReprojectTests tests;
    float minAlbedo;  // 0: light is not demodulated
    float ofMean;     // converts a mean squared deviation to the variance of the mean; 0 where it is unknown
    float lobeScale;  // lobe.glsl
    float alpha;
    float alphaMoments;
    float alphaFast;
    float longest;  // frames
    SvgfLagParams lag;
};

struct SvgfTileSumsParams {
    uint width;  // pixels
    uint height;
    SvgfLagParams lag;
};

struct SvgfTilesParams {
    uint columns;  // tiles
    uint rows;
    SvgfLagParams lag;
};

struct SvgfAntilagParams {
    uint width;
    uint height;
    float minAlbedo;
    float ofMean;
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
    float roughnessScale;      // log2(e) / phi_roughness, of 1 / 255
    float stabilisationAlpha;  // 1 if there is no stabilised history
    float stabilisationNoise;  // tolerated difference from the stabilised history
    float fireflies;           // tolerated deviations from the neighbours, of a history of one frame
    int youngRadius;           // pixels, of a history of one frame
    float samples;             // in each frame's light; 1 if its variance is unknown
};

#ifndef __cplusplus
/// Factor for a deviation: the mean of a longer history has less noise.
float svgfBoost(bool boost, float frames) {
    return boost ? 2.0 * inversesqrt(max(frames, 1.0)) : 1.0;
}

/// The same where the samples of a frame tell its variance. They do not know that Sobol' points are spread
/// evenly, and that their mean has less noise. Chosen on the laboratory's first frames, of 4 and of 32
/// samples.
float svgfSampledBoost(float frames) {
    return 0.75 * inversesqrt(max(frames, 1.0));
}
#endif

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif
