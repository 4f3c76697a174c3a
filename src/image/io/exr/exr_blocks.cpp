#include "image/io/exr/exr_blocks.h"

#include <ImfDeepScanLineInputPart.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfDeepTiledInputPart.h>
#include <ImfDeepTiledOutputPart.h>
#include <ImfInputPart.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTiledInputPart.h>
#include <ImfTiledOutputPart.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace limpid::image {
namespace {

/// Checks the sizes in a deep block: copying trusts them, however large, and reads other memory if their sum
/// overflows. `read` is rawPixelData() or rawTileData(), and the block begins with `headerBytes`.
template <typename Read>
void checkDeepBlock(size_t fileBytes, size_t headerBytes, Read read) {
    uint64_t size = 0;
    read(nullptr, size);  // returns the size
    if (size < headerBytes || size > fileBytes)
        throw std::runtime_error("it has a deep block of absurd size");
    std::vector<char> block(size);
    read(block.data(), size);
    std::array<uint64_t, 2> sizes{};  // of the table of sample counts, and of the samples
    std::memcpy(sizes.data(), block.data() + headerBytes - 24, sizeof sizes);
    const uint64_t content = size - headerBytes;
    if (sizes[0] > content || sizes[1] != content - sizes[0])
        throw std::runtime_error("it has a damaged deep block");
}

void checkDeepBlocks(Imf::DeepScanLineInputPart part, size_t fileBytes) {
    const Imath::Box2i data = part.header().dataWindow();
    for (int y = data.min.y; y <= data.max.y; ++y)
        checkDeepBlock(fileBytes, 28, [&](char* to, uint64_t& size) { part.rawPixelData(y, to, size); });
}

void checkDeepBlocks(Imf::DeepTiledInputPart part, size_t fileBytes) {
    for (int ly = 0; ly < part.numYLevels(); ++ly) {
        for (int lx = 0; lx < part.numXLevels(); ++lx) {
            if (!part.isValidLevel(lx, ly)) continue;
            for (int i = 0; i < part.numXTiles(lx) * part.numYTiles(ly); ++i) {
                int x = i % part.numXTiles(lx), y = i / part.numXTiles(lx);
                checkDeepBlock(fileBytes, 40,
                               [&](char* to, uint64_t& size) { part.rawTileData(x, y, lx, ly, to, size); });
            }
        }
    }
}

}  // namespace

void copyExrBlocks(Imf::MultiPartInputFile& from, Imf::MultiPartOutputFile& to, int index,
                   const Imf::Header& header, size_t fileBytes) {
    const bool deep = header.hasType() && Imf::isDeepData(header.type());
    const bool tiled = header.hasTileDescription();
    const auto copy = [&]<typename In, typename Out>(In in, Out out) { out.copyPixels(in); };
    if (deep && tiled) checkDeepBlocks(Imf::DeepTiledInputPart(from, index), fileBytes);
    if (deep && !tiled) checkDeepBlocks(Imf::DeepScanLineInputPart(from, index), fileBytes);
    if (deep && tiled) return copy(Imf::DeepTiledInputPart(from, index), Imf::DeepTiledOutputPart(to, index));
    if (deep) return copy(Imf::DeepScanLineInputPart(from, index), Imf::DeepScanLineOutputPart(to, index));
    if (tiled) return copy(Imf::TiledInputPart(from, index), Imf::TiledOutputPart(to, index));
    copy(Imf::InputPart(from, index), Imf::OutputPart(to, index));
}

}  // namespace limpid::image
