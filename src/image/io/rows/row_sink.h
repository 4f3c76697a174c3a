// Receives the rows of a picture while it is decoded. Private to src/image.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "image/io/rows/memory_bound.h"

namespace limpid::image {

/// 3 floats per pixel: linear RGB.
struct RowSink {
    /// Called once, before anything is allocated: the size, and the bytes that decoding needs besides the
    /// file and the sink's own data. May throw.
    std::function<void(PictureSize size, uint64_t memory)> begin;
    /// Called for every row, from top to bottom or from bottom to top; may change the row.
    std::function<void(uint32_t y, std::span<float> row)> row;
};

}  // namespace limpid::image
