// The denoiser of visibility in double precision, written only from the formulas of docs/denoising.md,
// "Visibility". Each step takes its input as an argument, so that it can be given values that a device stored
// and be compared on its own. Nothing is rounded.
#pragma once

#include <vector>

#include "tests/oracle/svgf/double_svgf.h"

namespace limpid::test {

struct DoubleVisibilityParams {
    double alpha = 0.05, alphaFast = 0.5;
    double normalTest = 0.95, depthTest = 0.02;
    double antilag = 64.0, antilagNoise = 2.5;
    int youngRadius = 4;  ///< 0: off
    double phi = 4.0, phiNormal = 64.0, phiDepth = 2.0;
};

/// Images of another size than the frame's (empty before the first frame) count as no hit everywhere.
struct VisibilityHistory {
    uint32_t width = 0, height = 0;
    SvgfSurfaces surfaces;
    std::vector<dvec4> moments;  ///< m1, m2, f, N
};

struct VisibilityPixel {
    bool rejected = false;
    /// A decision was so close that float32 may decide otherwise: skip the comparison here.
    bool doubtful = false;
    /// Bounds the change of the moments if the reprojected position s is off by one pixel.
    dvec4 slope{0.0};
};

struct VisibilityAccumulated {
    std::vector<dvec4> moments;  ///< m1', m2', f', N'; 0 where nothing is seen
    std::vector<VisibilityPixel> pixels;
};

/// x, or nothing for a rejected sample.
std::optional<double> visibilitySample(const denoise::HostFrame& frame, size_t p);

/// Step 2.
VisibilityAccumulated visibilityAccumulate(const denoise::HostFrame& frame, const VisibilityHistory& previous,
                                           const DoubleVisibilityParams& params);

/// The lags of step 3; see svgfTiles().
SvgfTiles visibilityTiles(const denoise::HostFrame& frame, const std::vector<dvec4>& moments,
                          const DoubleVisibilityParams& params, const std::vector<dvec4>& errors);

/// The rest of step 3: shortens histories. `lags` are those of the tiles.
void visibilityShorten(const denoise::HostFrame& frame, const std::vector<double>& lags,
                       const DoubleVisibilityParams& params, VisibilityAccumulated& accumulated);

/// What the levels start from: v and sigma. `moments` as they are stored.
dvec2 visibilitySignal(const denoise::HostFrame& frame, size_t p, const dvec4& moments);

/// Fills young pixels of `filtered`, the result of level 0 of step 4; `signal` is its input. Returns the
/// pixels of which float32 may decide otherwise that there is nothing to fill them with.
std::vector<bool> visibilityFillYoung(const denoise::HostFrame& frame, const SvgfSurfaces& surfaces,
                                      const std::vector<dvec2>& signal, const std::vector<dvec4>& moments,
                                      const DoubleVisibilityParams& params, std::vector<dvec2>& filtered);

/// Level `i` of step 4, without young pixels being filled. Uses only the size and the camera of the frame.
std::vector<dvec2> visibilityLevel(const denoise::HostFrame& frame, const SvgfSurfaces& surfaces,
                                   const std::vector<dvec2>& signal, int i,
                                   const DoubleVisibilityParams& params);

}  // namespace limpid::test
