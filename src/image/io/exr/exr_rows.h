// The colours of an EXR file, row by row. Private to src/image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "image/io/row_sink.h"

namespace limpid::image {

/// The layer of LayeredImage::colorLayer, or "Y" as grey, over the display window, from top to bottom; what
/// the data window lacks is 0. No other channel is decoded. OpenEXR gets as many threads as keep its buffers
/// within a quarter of `maxMemory`. Throws InputError.
void decodeExrRows(std::span<const std::byte> bytes, const std::filesystem::path& name, const RowSink& sink,
                   uint64_t maxMemory);

}  // namespace limpid::image
