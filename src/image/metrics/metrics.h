// Metrics of the difference between a picture and its reference. See docs/metrics.md.
//
// PSNR, SSIM and FLIP compare display-encoded pictures: radiance * 2^stops, clamped to [0,1], sRGB-encoded,
// without a filmic curve (displayEncode()). relMSE compares linear radiance without exposure. Images must
// have 3 components and equal sizes, or functions throw Error.
#pragma once

#include <cstdint>
#include <functional>

#include "image/image.h"

namespace limpid::image {

/// The default for FLIP, pixels per degree of visual angle: a screen that is 0.7 m and 3840 pixels wide, seen
/// from 0.7 m.
inline constexpr double flipPixelsPerDegree = 3840.0 * 3.14159265358979323846 / 180.0;  // 67.02

struct Comparison {
    double psnr = 0.0;           ///< dB, infinite for equal images
    double ssim = 0.0;           ///< 1 for equal images
    double relMse = 0.0;         ///< 0 for equal images
    double flip = 0.0;           ///< mean of flipMap: 0 for equal images, at most 1
    float exposure = 0.0f;       ///< the exposure that was applied, in stops
    uint64_t invalidPixels = 0;  ///< pixels of the test image with a NaN or an infinity
    Image flipMap;               ///< FLIP of each pixel, one component in [0,1]
    Image shownTest;  ///< the display-encoded test picture, with invalid pixels replaced by the worst value
    Image shownReference;
};

/// Computes all metrics of `test` against `reference`, both linear radiance.
///
/// An invalid pixel of `test` (with a NaN or an infinity) counts as the largest possible error, so that it
/// neither makes the means NaN nor goes unnoticed: in PSNR and SSIM each component is black or white,
/// whichever is farther from the reference; in the FLIP map it is 1; in relMSE each component is 65504 (the
/// largest half). Throws Error if `reference` has invalid pixels.
Comparison compare(const Image& test, const Image& reference, float exposureStops);

/// Returns radiance * 2^stops, clamped to [0,1], sRGB-encoded. NaN becomes 0.
Image displayEncode(const Image& radiance, float stops);

/// Returns 10 log10(1 / MSE) over all pixels and components of display-encoded images; infinite if equal.
double psnr(const Image& test, const Image& reference);

/// Returns the mean structural similarity of the Rec. 709 luma of display-encoded images (Wang et al., "Image
/// Quality Assessment: From Error Visibility to Structural Similarity", 2004): 11x11 Gaussian window, sigma
/// 1.5, K1 0.01, K2 0.03, range 1. As in the paper's code, the mean covers pixels whose window lies within
/// the image. If the image is smaller than 11 pixels in a direction, its border is repeated in that
/// direction, and all its columns or rows count.
double ssim(const Image& test, const Image& reference);

/// Returns mean((x - r)^2 / (r^2 + 0.01)) over all pixels and components of linear radiance.
double relMse(const Image& test, const Image& reference);

/// Returns the LDR-FLIP map of display-encoded images, one component in [0,1] per pixel (Andersson et al.,
/// "FLIP: A Difference Evaluator for Alternating Images", 2020, with its constants). The FLIP value of a
/// picture is the mean of its map.
Image flip(const Image& test, const Image& reference, double pixelsPerDegree = flipPixelsPerDegree);

/// The exposures at which HDR-FLIP compares: `count` of them, evenly spaced from `start` to `stop` (in
/// stops).
struct HdrFlipExposures {
    double start = 0.0;
    double stop = 0.0;
    int count = 2;
};

/// Chooses the exposures from the reference's luminances (section 2.1 of the paper cited at hdrFlip()): at
/// `start` the brightest pixel is tone-mapped to 0.85, at `stop` the median one; count = max(2, ceil(stop -
/// start)). Negative components count as 0. Two cases are not in the paper: if the median is 0, the median of
/// the pixels brighter than 0 is used; for a black reference, start = stop = 0. Throws Error if the reference
/// has invalid pixels.
HdrFlipExposures hdrFlipExposures(const Image& reference);

/// Called after each exposure with the number of finished ones and the total.
using HdrFlipProgress = std::function<void(int done, int count)>;

struct HdrFlip {
    HdrFlipExposures exposures;
    double value = 0.0;  ///< mean of the map: 0 for equal images, at most 1
    Image map;           ///< each pixel's largest LDR-FLIP over all exposures, one component in [0,1]
};

/// Computes HDR-FLIP of linear radiance (Andersson et al., "Visualizing Errors in Rendered High Dynamic Range
/// Images", Eurographics 2021 short papers): for every exposure c, both images are multiplied by 2^c,
/// tone-mapped with the filmic curve (image/filmic.h, also the paper's default) and compared with LDR-FLIP.
/// Exposures are chosen automatically, and scaling both images by the same factor does not change the result.
/// Handles invalid pixels and throws Error as compare() does.
HdrFlip hdrFlip(const Image& test, const Image& reference, double pixelsPerDegree = flipPixelsPerDegree,
                const HdrFlipProgress& progress = {});

/// Returns the arithmetic mean of all values.
double mean(const Image& image);

}  // namespace limpid::image
