// A picture as it is shown.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/graph/frame_graph.h"
#include "image/io/png/png.h"

namespace limpid::studio {

/// Exposed, and encoded as sRGB.
struct Picture {
    gpu::Extent extent;
    std::vector<uint32_t> texels;  ///< RGBA8, red in the lowest byte; row 0 is the upper one
};

/// RGBA8, red in the lowest byte; opaque where the image has three components.
std::vector<uint32_t> packedTexels(const image::ByteImage& bytes);

}  // namespace limpid::studio
