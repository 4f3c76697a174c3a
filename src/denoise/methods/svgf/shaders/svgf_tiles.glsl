// How far the slow mean of a signal's luminance lags behind the fast mean, estimated from sums over 8x8 pixels or
// more. docs/denoising.md, SVGF, step 4.
#include "denoise/methods/svgf/shaders/svgf_moments.glsl"
#include "denoise/methods/svgf/svgf_params.h"

struct TileSums {
    float lag, noise, light;
};

/// The contribution of one pixel; `m` are its moments. Its lag is limited to a multiple of its
/// own noise, so that a single bright sample does not look like a change of light.
TileSums tileSumsOf(vec4 m, SvgfLagParams lag) {
    if (m.w < SVGF_MIN_FRAMES) return TileSums(0.0, 0.0, 0.0);
    const float noise = lag.steadyShare * varianceOf(m), limit = lag.antilagPixel * sqrt(noise);
    return TileSums(clamp(m.z - m.x, -limit, limit), noise, max(m.z, m.x));
}

void add(inout TileSums sums, TileSums other) {
    sums = TileSums(sums.lag + other.lag, sums.noise + other.noise, sums.light + other.light);
}

vec4 packedSums(TileSums sums) {
    return vec4(sums.lag, sums.noise, sums.light, 0.0);
}

TileSums unpackedSums(vec4 texel) {
    return TileSums(texel.x, texel.y, texel.z);
}

float lagOf(TileSums sums, SvgfLagParams lag) {
    const float excess = max(abs(sums.lag) - lag.antilagNoise * sqrt(sums.noise), 0.0);
    return sums.light > 0.0 ? min(lag.antilag * excess / sums.light, 1.0) : 0.0;
}
