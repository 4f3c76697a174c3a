// Spatiotemporal variance-guided filtering in double precision, written from the formulas of
// docs/denoising.md and from nothing else: the oracle of the denoiser `svgf`. Each step takes its input as an
// argument, so that it can be given what a device stored (halves, packed normals) and be compared alone.
// Nothing is rounded, except that what is stored as a half is at most 65504 in magnitude.
#pragma once

#include <vector>

#include "tests/oracle/double_frame.h"

namespace limpid::test {

struct DoubleSvgfParams {
    bool demodulate = true;
    double alpha = 0.2, alphaMoments = 0.2, alphaFast = 0.5;
    double normalTest = 0.95, depthTest = 0.02;
    bool relative = true, search = true;
    bool reflections = true;
    double antilag = 2.0, antilagNoise = 3.0, antilagPixel = 1e9;
    double stabilisationAlpha = 0.5, stabilisationNoise = 1.0;
    double phiColor = 4.0, phiNormal = 128.0, phiDepth = 1.0;
    int blurLevels = 1;
    bool boost = true, wide = true, position = false;
};

/// What is filtered apart: `Joint` is the sum of the other two.
enum class SvgfSignal { Joint, Diffuse, Specular };

/// Step 1.
struct SvgfSurfaces {
    std::vector<dvec3> normal;
    std::vector<double> distance;  ///< z; 0 where nothing is seen
    std::vector<double> id;        ///< instance number + 1; 0 where nothing is seen
};
SvgfSurfaces svgfSurfaces(const denoise::HostFrame& frame);
/// Of what a device stored: two words a pixel (normal, bits of z as a float) and one (id).
SvgfSurfaces decodeSurfaces(const std::vector<uint32_t>& words, const std::vector<uint32_t>& ids);

/// What lives from frame to frame, of one signal. Images of another size than the frame's (none at all before
/// the first frame) mean that nothing was seen.
struct SvgfHistory {
    uint32_t width = 0, height = 0;
    SvgfSurfaces surfaces;
    std::vector<dvec4> color;    ///< c; the fourth is not read
    std::vector<dvec4> moments;  ///< m1, m2, f, N
    std::vector<dvec4>
        stable;  ///< of step 7; the fourth is not read. None at all if nothing was stabilised so far
};

struct SvgfPixel {
    int failure = 0;         ///< 0: history was found; else the failure case of history tracking
    bool reflected = false;  ///< the history is that of where the reflection was
    bool rejected = false;   ///< the sample has a NaN or an infinity
    /// A decision was so close that float32 may take the other one: compare nothing here.
    bool doubtful = false;
    /// By how much the results change at most if the back-projected position s is off by one pixel.
    dvec4 colorSlope{0.0}, momentsSlope{0.0}, stablePastSlope{0.0};
    /// The magnitude of what was averaged: what rounding is relative to.
    dvec4 colorOperands{0.0}, momentsOperands{0.0};
};

/// c' with sigma, the moments, and h with b.
struct SvgfAccumulated {
    std::vector<dvec4> color, moments, stablePast;
    std::vector<SvgfPixel> pixels;
};

/// C / M of one signal: what is filtered. `rejected` samples are 0.
struct SvgfSample {
    dvec3 x{0.0};
    bool rejected = false;
};
SvgfSample svgfSample(const denoise::HostFrame& frame, SvgfSignal signal, size_t p, bool demodulate);

inline double luminance(const dvec3& color) {
    return glm::dot(color, dvec3(0.2126, 0.7152, 0.0722));
}

/// sigma of one pixel's moments. `error` is added to m2 - m1^2 before anything else: the bounds of what
/// float32 may make of the difference.
double svgfDeviation(double m1, double m2, double error = 0.0);
/// By which the deviation is multiplied.
double svgfBoost(double frames, bool boost);

/// Steps 2 and 3.
SvgfAccumulated svgfAccumulate(const denoise::HostFrame& frame, SvgfSignal signal,
                               const SvgfHistory& previous, const DoubleSvgfParams& params);

/// Step 4's tiles. They are 8x8 pixels, row 0 first; `error` bounds what float32 does to each one's lag, and
/// what comes of errors of the moments (one for each component, or none at all). It is infinite where one of
/// them decides whether a pixel counts.
struct SvgfTiles {
    std::vector<double> tiles, error;
};
SvgfTiles svgfTiles(const denoise::HostFrame& frame, const std::vector<dvec4>& moments,
                    const DoubleSvgfParams& params, const std::vector<dvec4>& errors = {});

/// Step 4's anti-lag: shortens the histories of what step 3 made. The slopes hold for the result.
void svgfShorten(const denoise::HostFrame& frame, SvgfSignal signal, const std::vector<double>& tiles,
                 const DoubleSvgfParams& params, SvgfAccumulated& accumulated);

/// k of step 4: the variance of f - m1 under steady light, as a share of E[m2 - m1^2].
double svgfSteadyShare(const DoubleSvgfParams& params);

/// zx and zy of step 6.
dvec2 svgfSlope(const denoise::HostFrame& frame, size_t p, const dvec3& normal, double distance);

/// Step 5. `color`: of step 3. `error` bounds what float32 may make of each pixel's sigma^2; it is infinite
/// where all weights are so small that float32 may not hold them.
struct SvgfVariance {
    std::vector<dvec4> color;
    std::vector<double> error;
};
SvgfVariance svgfYoungVariance(const denoise::HostFrame& frame, const SvgfSurfaces& surfaces,
                               const std::vector<dvec4>& color, const std::vector<dvec4>& moments,
                               const DoubleSvgfParams& params);

/// Level `i` of step 6. Of the frame only the size and the camera are read.
std::vector<dvec4> svgfLevel(const denoise::HostFrame& frame, const SvgfSurfaces& surfaces,
                             const std::vector<dvec4>& color, uint32_t i, const DoubleSvgfParams& params);

/// Step 7 for one pixel that sees something. `color`: c with sigma; `past`: h with b.
dvec3 svgfStable(const dvec4& color, const dvec4& past, const DoubleSvgfParams& params);

/// Step 8, of what step 7 made; alpha 1.
struct SvgfFiltered {
    SvgfSignal signal;
    std::vector<dvec4> color;
};
std::vector<dvec4> svgfModulate(const denoise::HostFrame& frame, const std::vector<SvgfFiltered>& signals,
                                bool demodulate);

}  // namespace limpid::test
