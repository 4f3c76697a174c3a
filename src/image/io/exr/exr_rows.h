// Reads the colours of an EXR file row by row. Private to src/image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "image/io/rows/row_sink.h"

namespace limpid::image {

/// Decodes the layer of LayeredImage::colorLayer, or "Y" as grey, over the display window, from top to
/// bottom; pixels that the data window lacks are 0. Decodes no other channel. OpenEXR gets as many threads as
/// keep its buffers within a quarter of `maxMemory`. Throws InputError.
void decodeExrRows(std::span<const std::byte> bytes, const std::filesystem::path& name, const RowSink& sink,
                   uint64_t maxMemory);

}  // namespace limpid::image
