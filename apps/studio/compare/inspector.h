// Images of single passes on the screen: what `limpid render --dump` writes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "image/image.h"

namespace limpid::studio {

/// How an image of a pass is shown.
struct InspectorView {
    enum Channels { Color, Red, Green, Blue, Alpha };
    int channels = Color;  ///< Color: the first three, or one as grey
    float stops = 0.0f;    ///< values are multiplied with 2^stops; what is shown as white is 1 then
    bool falseColor =
        false;  ///< of one channel: black over purple and orange to pale yellow; of Color, of the luminance
    bool operator==(const InspectorView&) const = default;
};

/// RGBA8, red in the lowest byte, encoded sRGB. Values below 0 are black; what is no finite number is
/// magenta.
std::vector<uint32_t> shownTexels(const image::Image& picture, const InspectorView& view);

}  // namespace limpid::studio
