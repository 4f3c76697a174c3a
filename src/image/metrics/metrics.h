// How far a picture is from its reference. See docs/metrics.md.
//
// PSNR, SSIM and FLIP see what a screen would show: radiance * 2^stops, clamped to [0,1], sRGB-encoded,
// without a filmic curve (displayEncode). relMSE sees linear radiance, unexposed. Images have 3 components
// and equal sizes; every function throws Error if they have not.
#pragma once

#include <cstdint>
#include <functional>

#include "image/image.h"

namespace limpid::image {

/// Pixels per degree of visual angle that FLIP assumes: a screen 0.7 m and 3840 pixels wide, seen from 0.7 m.
inline constexpr double flipPixelsPerDegree = 3840.0 * 3.14159265358979323846 / 180.0;  // 67.02

struct Comparison {
    double psnr = 0.0;           ///< dB, infinite for equal images
    double ssim = 0.0;           ///< 1 for equal images
    double relMse = 0.0;         ///< 0 for equal images
    double flip = 0.0;           ///< mean of flipMap: 0 for equal images, at most 1
    float exposure = 0.0f;       ///< stops that were applied
    uint64_t invalidPixels = 0;  ///< pixels of the test image with a NaN or an infinity
    Image flipMap;               ///< FLIP of each pixel, one component in [0,1]
    Image shownTest;  ///< what PSNR, SSIM and FLIP saw: exposed, encoded, invalid pixels at their worst
    Image shownReference;
};

/// All metrics of linear radiance `test` against `reference`.
///
/// An invalid pixel of `test` (a component is NaN or infinite) counts as the worst that its pixel can be, so
/// that it neither poisons the means nor passes unseen: shown as black or white, whichever is farther from
/// the reference's component, in PSNR and SSIM; 1 in the FLIP map; 65504 (the largest half) in each component
/// in relMSE. Throws Error if `reference` has invalid pixels: there is no truth to compare with.
Comparison compare(const Image& test, const Image& reference, float exposureStops);

/// radiance * 2^stops, clamped to [0,1], sRGB-encoded. NaN gives 0.
Image displayEncode(const Image& radiance, float stops);

/// 10 log10(1 / MSE) over all pixels and components of encoded images; infinite if they are equal.
double psnr(const Image& test, const Image& reference);

/// Mean structural similarity of the Rec. 709 luma of encoded images (Wang et al., "Image Quality Assessment:
/// From Error Visibility to Structural Similarity", 2004): 11x11 Gaussian window, sigma 1.5, K1 0.01, K2
/// 0.03, range 1. As in the paper's own code, the mean is over pixels whose window lies within the image. An
/// image narrower (lower) than 11 pixels repeats its border in that direction and counts all its columns
/// (rows).
double ssim(const Image& test, const Image& reference);

/// mean((x - r)^2 / (r^2 + 0.01)) over all pixels and components of linear radiance.
double relMse(const Image& test, const Image& reference);

/// LDR-FLIP of encoded images, one component in [0,1] per pixel (Andersson et al., "FLIP: A Difference
/// Evaluator for Alternating Images", 2020, with its constants). The picture's value is the map's mean.
Image flip(const Image& test, const Image& reference, double pixelsPerDegree = flipPixelsPerDegree);

/// The exposures that HDR-FLIP looks at: `count` of them, evenly spaced from `start` to `stop` (stops).
struct HdrFlipExposures {
    double start = 0.0;
    double stop = 0.0;
    int count = 2;
};

/// Chosen by the reference's luminances alone (section 2.1 of the paper below): the brightest pixel tone-maps
/// to 0.85 at `start`, the median one at `stop`; count = max(2, ceil(stop - start)). Negative components
/// count as 0. Where the paper has no answer: if the median is 0 it is taken over the pixels brighter than 0;
/// a black reference has start = stop = 0. Throws Error if the reference has invalid pixels.
HdrFlipExposures hdrFlipExposures(const Image& reference);

/// Is told how many exposures are done, and how many there are.
using HdrFlipProgress = std::function<void(int done, int count)>;

struct HdrFlip {
    HdrFlipExposures exposures;
    double value = 0.0;  ///< mean of the map: 0 for equal images, at most 1
    Image map;           ///< the largest LDR-FLIP over all exposures of each pixel, one component in [0,1]
};

/// HDR-FLIP of linear radiance (Andersson et al., "Visualizing Errors in Rendered High Dynamic Range Images",
/// Eurographics 2021 short papers): LDR-FLIP of both images times 2^c through the filmic curve
/// (image/filmic.h, the paper's default, too), for every exposure c. No exposure has to be given, and
/// scaling both images by one factor changes nothing. Invalid pixels of `test` count as in compare(). Throws
/// Error as compare() does.
HdrFlip hdrFlip(const Image& test, const Image& reference, double pixelsPerDegree = flipPixelsPerDegree,
                const HdrFlipProgress& progress = {});

/// Arithmetic mean of all values.
double mean(const Image& image);

}  // namespace limpid::image
