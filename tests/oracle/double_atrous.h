// The edge-avoiding a-trous filter in double precision, written only from the formulas of docs/denoising.md:
// the oracle of the denoiser `atrous`. Each step takes its input as an argument, so that it can be given
// values that a device stored (halves, packed normals) and be compared on its own. Names such as C, L and d
// are those of docs/denoising.md.
#pragma once

#include <vector>

#include "tests/oracle/double_frame.h"

namespace limpid::test {

struct DoubleAtrousParams {
    uint32_t levels = 5;
    double normalFactor = 3e-4;
    double depthFactor = 1e-4;
    double sampleTarget = 32.0;  ///< 0: no limit
    bool plane = true;
    double minAlbedo = 0.1;    ///< 0: light is filtered with its albedo
    double colorFactor = 0.0;  ///< 0: differences of light are ignored
};

struct AtrousGeometry {
    std::vector<dvec3> normal;
    /// d: the distance along the camera's `forward`; with `plane` off, from the eye. 0 where the ray misses.
    std::vector<double> distance;
};

struct Demodulated {
    std::vector<dvec4> light;  ///< demodulated light L, and in w the sample count N of the mean
    AtrousGeometry geometry;
};

/// Returns the scattered light C, and 1 in w: the filter's input with `atrous.temporal=off`.
std::vector<dvec4> scatteredLight(const denoise::HostFrame& frame);

/// Computes step 1, without rounding. `mean`: the history's mean with its count, or scatteredLight().
Demodulated demodulate(const denoise::HostFrame& frame, const std::vector<dvec4>& mean,
                       const DoubleAtrousParams& params);

/// Computes level `i` of the filter. Uses only the size and the camera of the frame.
std::vector<dvec4> level(const denoise::HostFrame& frame, const std::vector<dvec4>& light,
                         const AtrousGeometry& geometry, uint32_t i, const DoubleAtrousParams& params);

/// Computes step 3, the denoised picture with alpha 1.
std::vector<dvec4> modulate(const denoise::HostFrame& frame, const std::vector<dvec4>& light,
                            const DoubleAtrousParams& params);

/// Runs all steps.
std::vector<dvec4> filterAtrous(const denoise::HostFrame& frame, const std::vector<dvec4>& mean,
                                const DoubleAtrousParams& params);

/// Decodes a unit vector from two signed normalised numbers of `bits` bits, x in the low ones, like
/// decodeOctahedral() of src/shaders/common/sampling.glsl.
dvec3 decodeOctahedral(uint32_t packed, int bits = 16);

/// Decodes two words per pixel: the normal, and the bits of d as a float.
AtrousGeometry decodeGeometry(const std::vector<uint32_t>& words);

}  // namespace limpid::test
