// Spatiotemporal variance-guided filtering in double precision, written only from the formulas of
// docs/denoising.md: the oracle of the denoiser `svgf`. Each step takes its input as an argument, so that it
// can be given values that a device stored (halves, packed normals) and be compared on its own. Nothing is
// rounded, except that values stored as halves are limited to 65504 in magnitude.
//
// Steps and symbols are those of docs/denoising.md, "Spatiotemporal variance-guided filtering": colour c with
// standard deviation sigma, moments m1 and m2, fast mean f, history length N, stable light h and its weight
// b.
#pragma once

#include <algorithm>
#include <vector>

#include "tests/oracle/double_frame.h"

namespace limpid::test {

struct DoubleSvgfParams {
    double minAlbedo = 0.1;  ///< 0: light is filtered with its albedo
    double alpha = 0.2, alphaMoments = 0.2, alphaFast = 0.5;
    double normalTest = 0.95, depthTest = 0.02;
    bool relative = true, search = true;
    bool reflections = true;
    double antilag = 2.0, antilagNoise = 3.0, antilagPixel = 1e9;
    bool antilagAround = false;
    double fireflies = 0.0;
    int youngRadius = 0;
    double stabilisationAlpha = 0.5, stabilisationNoise = 1.0;
    double phiColor = 4.0, phiNormal = 128.0, phiDepth = 1.0;
    double lobeTest = 0.0, phiRoughness = 0.0;
    int blurLevels = 1, meanLevels = 0;
    bool dampOutliers = false;
    bool boost = true, wide = true, position = false;
};

/// The signals that can be filtered separately: `Joint` is the sum of the other two.
enum class SvgfSignal { Joint, Diffuse, Specular };

/// The result of step 1.
struct SvgfSurfaces {
    std::vector<dvec3> normal;
    std::vector<double> distance;   ///< z; 0 where the ray misses
    std::vector<double> id;         ///< instance number + 1; 0 where the ray misses
    std::vector<double> roughness;  ///< 1 if it is unknown
};
SvgfSurfaces svgfSurfaces(const denoise::HostFrame& frame);
/// Decodes what a device stored, two words per pixel: normal and roughness, then z (6 bits of exponent and 13
/// of mantissa) and the id (13 bits).
SvgfSurfaces decodeSurfaces(const std::vector<uint32_t>& words);

/// The history of one signal. Images of another size than the frame's (empty before the first frame) count as
/// no hit everywhere.
struct SvgfHistory {
    uint32_t width = 0, height = 0;
    SvgfSurfaces surfaces;
    std::vector<dvec4> color;    ///< c; the fourth component is ignored
    std::vector<dvec4> moments;  ///< m1, m2, f, N
    std::vector<dvec3> stable;   ///< from step 7. Empty if nothing has been stabilised yet
};

struct SvgfPixel {
    int failure = 0;         ///< 0: history was found; else as Reprojection::failure
    bool reflected = false;  ///< the history was found by the reflection's motion
    bool rejected = false;   ///< the sample has a NaN or an infinity
    /// A decision was so close that float32 may decide otherwise: skip the comparison here.
    bool doubtful = false;
    /// Bounds the change of the results if the reprojected position s is off by one pixel.
    dvec4 colorSlope{0.0}, momentsSlope{0.0};
    dvec3 stablePastSlope{0.0};
    /// The magnitude of the averaged values. Rounding errors are relative to it.
    dvec4 colorOperands{0.0}, momentsOperands{0.0};
};

/// The result of steps 2 and 3: c' with sigma, the moments (m1', m2', f', N'), and h.
struct SvgfAccumulated {
    std::vector<dvec4> color, moments;
    std::vector<dvec3> stablePast;
    std::vector<SvgfPixel> pixels;
};

/// The demodulated light x = C / M of one signal, the input of the filter; 0 for `rejected` samples.
/// `variance`: v, that of its luminance; 0 where it is unknown.
struct SvgfSample {
    dvec3 x{0.0};
    bool rejected = false;
    double variance = 0.0;
};
/// S: the samples of each pixel, of which the variance is known; else 1.
inline double svgfSamples(const denoise::HostFrame& frame) {
    return frame.variances ? static_cast<double>(std::max(frame.samples, 1u)) : 1.0;
}
SvgfSample svgfSample(const denoise::HostFrame& frame, SvgfSignal signal, size_t p, double minAlbedo);

inline double luminance(const dvec3& color) {
    return glm::dot(color, dvec3(0.2126, 0.7152, 0.0722));
}

/// Returns sigma for one pixel's moments. `error` is first added to m2 - m1^2; it bounds float32's error of
/// that difference.
double svgfDeviation(double m1, double m2, double error = 0.0);
/// Returns B, the factor of the standard deviation.
double svgfBoost(double frames, bool boost);

/// Computes steps 2 and 3.
SvgfAccumulated svgfAccumulate(const denoise::HostFrame& frame, SvgfSignal signal,
                               const SvgfHistory& previous, const DoubleSvgfParams& params);

/// The lag of each tile of step 4 (8x8 pixels, row 0 first). `error` bounds the error of the lag that float32
/// and errors of the moments cause. It is infinite where these errors may decide whether a pixel counts.
/// `errors` of svgfTiles(): bounds for each component of the moments; empty: no errors.
struct SvgfTiles {
    std::vector<double> tiles, error;
};
SvgfTiles svgfTiles(const denoise::HostFrame& frame, const std::vector<dvec4>& moments,
                    const DoubleSvgfParams& params, const std::vector<dvec4>& errors = {});

/// Applies step 4 to the result of step 3: shortens histories where the tiles' lag is large. Also updates the
/// slopes in `accumulated`.
void svgfShorten(const denoise::HostFrame& frame, SvgfSignal signal, const std::vector<double>& tiles,
                 const DoubleSvgfParams& params, SvgfAccumulated& accumulated);

/// Returns k of step 4: the variance of f - m1 under steady light, as a fraction of E[m2 - m1^2].
double svgfSteadyShare(const DoubleSvgfParams& params);

/// Returns the slopes of distance, zx and zy, of step 6.
dvec2 svgfSlope(const denoise::HostFrame& frame, size_t p, const dvec3& normal, double distance);

/// The result of step 5. `error` bounds float32's error of each pixel's sigma^2. It is infinite where all
/// weights are so small that they may underflow in float32.
struct SvgfVariance {
    std::vector<dvec4> color;
    std::vector<double> error;
};
SvgfVariance svgfYoungVariance(const denoise::HostFrame& frame, SvgfSignal signal,
                               const SvgfSurfaces& surfaces, const std::vector<dvec4>& color,
                               const std::vector<dvec4>& moments, const DoubleSvgfParams& params);

/// The factor of each pixel's light by which step 5 dims fireflies, and what float32 may make of it. `color`:
/// c with the sigma of step 5.
struct SvgfDimming {
    std::vector<double> factor, least, most;
};
SvgfDimming svgfDimming(const denoise::HostFrame& frame, SvgfSignal signal, const SvgfSurfaces& surfaces,
                        const std::vector<dvec4>& color, const std::vector<dvec4>& moments,
                        const DoubleSvgfParams& params);

/// Applies the filling of young pixels of step 6 to `filtered`, the result of level 0; `color` is its input.
/// Returns the pixels of which float32 may decide otherwise that there is nothing to fill them with.
std::vector<bool> svgfFillYoung(const denoise::HostFrame& frame, SvgfSignal signal,
                                const SvgfSurfaces& surfaces, const std::vector<dvec4>& color,
                                const std::vector<dvec4>& moments, const DoubleSvgfParams& params,
                                std::vector<dvec4>& filtered);

/// Computes level `i` of step 6, without young pixels being filled. Uses only the size and the camera of the
/// frame.
std::vector<dvec4> svgfLevel(const denoise::HostFrame& frame, SvgfSignal signal, const SvgfSurfaces& surfaces,
                             const std::vector<dvec4>& color, uint32_t i, const DoubleSvgfParams& params);

/// Returns b. `frames`: N', 1 - 2^-9 for a history that step 4 shortened to one frame; `wasStable`: something
/// has been stabilised before.
double svgfStableWeight(double frames, bool wasStable, const DoubleSvgfParams& params);

/// Decodes a word of stabilised light: three whole numbers of 9 bits with a common exponent in the upper 5.
dvec3 decodeStable(uint32_t word);

/// Computes step 7 for one pixel with a hit. `color`: c with sigma; `past`: h with b.
dvec3 svgfStable(const dvec4& color, const dvec4& past, const DoubleSvgfParams& params);

/// The filtered light of one signal, the input of step 8. svgfModulate() returns the picture with alpha 1.
struct SvgfFiltered {
    SvgfSignal signal;
    std::vector<dvec4> color;
};
std::vector<dvec4> svgfModulate(const denoise::HostFrame& frame, const std::vector<SvgfFiltered>& signals,
                                double minAlbedo);

}  // namespace limpid::test
