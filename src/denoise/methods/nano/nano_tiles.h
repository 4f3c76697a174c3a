// Parts of a picture that a network behind SVGF computes one after another, where its channels do not fit in
// one buffer.
#pragma once

#include <cstdint>
#include <vector>

#include "denoise/methods/nano/nano_network.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

/// All in pixels of the finest level. `x`, `y` and `extent` are multiples of 2^(NANO_LEVELS - 1), so the last
/// tiles may end beyond the picture.
struct NanoTile {
    uint32_t x = 0, y = 0;
    gpu::Extent extent;
    uint32_t innerX = 0, innerY = 0;  ///< from the picture's corner: the part that is kept, which lies in the
    gpu::Extent inner;                ///< picture and is the same as if the picture were one tile
};

/// The distance from a pixel beyond which the network's result there depends on nothing.
uint32_t nanoReach(const NanoNetwork& network);

/// Tiles of one size, of at most `mostPixels`, that cover the picture with the fewest pixels: one for all of
/// it if that is small enough. Each overlaps the inner part of its neighbours by `reach` or more. Empty if so
/// few pixels have no inner part.
std::vector<NanoTile> nanoTiles(gpu::Extent picture, uint32_t reach, uint64_t mostPixels);

}  // namespace limpid::denoise
