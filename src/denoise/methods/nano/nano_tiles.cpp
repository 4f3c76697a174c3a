#include "denoise/methods/nano/nano_tiles.h"

#include <algorithm>
#include <array>
#include <optional>

#include "base/divide_up.h"

namespace limpid::denoise {
namespace {

constexpr uint32_t multiple = 1u << (NANO_LEVELS - 1);

uint32_t roundedUp(uint32_t size) {
    return divideUp(size, multiple) * multiple;
}

/// Parts of one side of a picture.
struct Parts {
    uint32_t count = 1;
    uint32_t size = 0;  ///< of each, with what overlaps
    uint32_t step = 0;  ///< from the beginning of one inner part to that of the next

    uint32_t begin(uint32_t number, uint32_t whole, uint32_t reach) const {
        const uint32_t inner = number * step;
        return std::min(inner > reach ? inner - reach : 0, whole - size);
    }
};

Parts partsOf(uint32_t whole, uint32_t count, uint32_t reach) {
    if (count == 1) return {.count = 1, .size = whole, .step = whole};
    const uint32_t step = roundedUp(divideUp(whole, count));
    return {.count = count, .size = std::min(step + 2 * reach, whole), .step = step};
}

}  // namespace

// Distances at a level count its pixels.
uint32_t nanoReach(const NanoNetwork& network) {
    constexpr size_t last = NANO_LEVELS - 1;
    const auto coarser = [](uint32_t distance) { return (distance + 1) / 2; };
    const auto finer = [](uint32_t distance) { return 2 * distance + 1; };
    std::array<uint32_t, NANO_LEVELS> filtered{}, light{}, logits{}, channels{};
    for (size_t i = 0; i < last; ++i) filtered[i + 1] = coarser(filtered[i]) + 1;
    for (size_t i = NANO_LEVELS; i-- > 0;) {
        light[i] = filtered[i] + (i > 0 ? NANO_REACH : NANO_FINEST_REACH);
        if (i < last) light[i] = std::max(light[i], finer(light[i + 1]));
    }
    // The light of the coarser level is made by this one's logits; `after` looks around, `join` at the
    // coarser level.
    for (size_t i = 0; i <= last; ++i) {
        logits[i] = std::max(filtered[i], i < last ? finer(light[i + 1]) : 0);
        if (i > 0) logits[i] = std::max(logits[i], coarser(logits[i - 1] + 1));
    }
    for (size_t i = NANO_LEVELS; i-- > 0;) {
        channels[i] = i < last ? std::max(logits[i] + 1, finer(channels[i + 1])) : logits[i];
        channels[i] += static_cast<uint32_t>(network.levels[i].around.size());
    }
    return channels[0];
}

std::vector<NanoTile> nanoTiles(gpu::Extent picture, uint32_t reach, uint64_t mostPixels) {
    const gpu::Extent whole{roundedUp(picture.width), roundedUp(picture.height)};
    const uint32_t overlap = roundedUp(reach);
    std::optional<std::array<Parts, 2>> best;
    uint64_t least = UINT64_MAX;
    for (uint32_t columns = 1; columns <= whole.width / multiple; ++columns) {
        const Parts across = partsOf(whole.width, columns, overlap);
        for (uint32_t rows = 1; rows <= whole.height / multiple; ++rows) {
            const Parts down = partsOf(whole.height, rows, overlap);
            const uint64_t pixels = uint64_t{across.size} * down.size;
            if (pixels > mostPixels) continue;
            if (pixels * columns * rows < least) {
                least = pixels * columns * rows;
                best = {across, down};
            }
            break;  // more rows only overlap more
        }
    }
    std::vector<NanoTile> tiles;
    if (!best) return tiles;
    const auto& [across, down] = *best;
    for (uint32_t j = 0; j < down.count; ++j) {
        for (uint32_t i = 0; i < across.count; ++i) {
            const uint32_t x = i * across.step, y = j * down.step;
            if (x >= picture.width || y >= picture.height) continue;
            tiles.push_back({.x = across.begin(i, whole.width, overlap),
                             .y = down.begin(j, whole.height, overlap),
                             .extent = {across.size, down.size},
                             .innerX = x,
                             .innerY = y,
                             .inner = {std::min(across.step, picture.width - x),
                                       std::min(down.step, picture.height - y)}});
        }
    }
    return tiles;
}

}  // namespace limpid::denoise
