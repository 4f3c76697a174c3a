// How exposed radiance becomes a colour on a display.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"

namespace limpid::image {

enum class ToneCurve {
    Standard,    ///< filmicCurve() of each channel
    Agx,         ///< AgX with its default contrast (image/tonemap_curve.h): bright colours turn white
    None,        ///< clipped at 1
    FalseColor,  ///< a colour for each stop of luminance
};

/// "standard", "agx", "none", "false-color".
const std::vector<std::string>& toneCurveNames();
std::string_view nameOf(ToneCurve curve);
/// Throws UsageError that lists the names.
ToneCurve parseToneCurve(std::string_view name);

/// Encoded sRGB in [0,1] of exposed linear radiance (Rec. 709). NaN and negative values count as 0.
vec3 displayColor(ToneCurve curve, const vec3& exposed);

/// The same for displays of a high dynamic range: ToneCurve::None that is not clipped at 1, paper white, but
/// at extendedLargest. sRGB's curve continues above 1.
vec3 extendedColor(const vec3& exposed);

/// The colours of ToneCurve::FalseColor from -6 to +6 stops from middle grey (0.18), one for each, encoded.
std::span<const vec3> falseColors();

}  // namespace limpid::image
