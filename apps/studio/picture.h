// A picture as it is shown.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/graph/frame_graph.h"
#include "image/image.h"
#include "image/io/png/png.h"

namespace limpid::studio {

/// Exposed, and encoded as sRGB. Row 0 is the upper one. Either of the two has texels.
struct Picture {
    gpu::Extent extent;
    std::vector<uint32_t> texels;  ///< RGBA8, red in the lowest byte
    /// Four halves, red in the lowest one: sRGB's curve continues above 1 (image::extendedColor()).
    std::vector<uint64_t> extended = {};
};

/// Texels of Picture::extended: extendedColor() of exposed radiance of 3 or more components.
std::vector<uint64_t> extendedTexels(const image::Image& radiance, float stops);

/// RGBA8, red in the lowest byte; opaque where the image has three components.
std::vector<uint32_t> packedTexels(const image::ByteImage& bytes);

}  // namespace limpid::studio
