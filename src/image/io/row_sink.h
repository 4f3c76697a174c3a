// What takes the rows of a picture while it is decoded. Private to src/image.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "image/io/memory_bound.h"

namespace limpid::image {

/// 3 floats a pixel: linear RGB.
struct RowSink {
    /// Once, before anything is allocated: the size, and the bytes that decoding takes beside the file and
    /// what the sink keeps. May throw.
    std::function<void(PictureSize size, uint64_t memory)> begin;
    /// Every row, from top to bottom or from bottom to top; the sink may change it.
    std::function<void(uint32_t y, std::span<float> row)> row;
};

}  // namespace limpid::image
