// Reads PNG with libpng, row by row. Private to src/image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "image/io/rows/memory_bound.h"

namespace limpid::image {

/// All functions throw InputError(name) if the file is damaged.
class PngReader {
  public:
    /// Reads everything before the pixels. Both arguments must outlive the reader.
    PngReader(std::span<const std::byte> bytes, const std::filesystem::path& name);
    ~PngReader();
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    PictureSize size() const;
    bool isInterlaced() const;
    bool has16Bits() const;

    /// Memory that decoding needs besides the returned pixels: libpng's rows, at most 8 bytes per pixel each.
    static uint64_t rowMemory(PictureSize size) { return uint64_t{size.width} * 32; }

    /// Call it first, and once. Pixels are returned as RGBA of 8 bits, or of 16 in native byte order. Grey
    /// becomes RGB, missing alpha the largest value; 16 bits are reduced to the upper 8.
    void begin(bool as16Bits);
    /// Reads the next row of a file that is not interlaced.
    void readRow(uint8_t* row);
    /// Reads all rows, interlaced or not.
    void readAll(uint8_t* pixels, size_t rowBytes);
    /// Reads to the end of the file. Throws if it is truncated.
    void finish();

  private:
    struct State;
    template <typename Call>
    void guarded(const Call& call);

    std::unique_ptr<State> state_;
    const std::filesystem::path& name_;
};

}  // namespace limpid::image
