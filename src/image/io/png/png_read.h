// PNG through libpng, row by row. Private to src/image.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "image/io/memory_bound.h"

namespace limpid::image {

/// All functions throw InputError(name) if the file is damaged.
class PngReader {
  public:
    /// Reads what comes before the pixels. Both arguments must outlive the reader.
    PngReader(std::span<const std::byte> bytes, const std::filesystem::path& name);
    ~PngReader();
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    PictureSize size() const;
    bool isInterlaced() const;
    bool has16Bits() const;

    /// What decoding takes beside the pixels that it returns: libpng's rows, at most 8 bytes a pixel each.
    static uint64_t rowMemory(PictureSize size) { return uint64_t{size.width} * 32; }

    /// To be called first, and once: pixels come as RGBA of 8 bits, or of 16 in this machine's byte order.
    /// Grey becomes RGB, missing alpha is the largest value; 8 bits of 16 are the higher ones.
    void begin(bool as16Bits);
    /// The next row of a file that is not interlaced.
    void readRow(uint8_t* row);
    /// All rows, interlaced or not.
    void readAll(uint8_t* pixels, size_t rowBytes);
    /// Reads to the end, which a whole file has.
    void finish();

  private:
    struct State;
    template <typename Call>
    void guarded(const Call& call);

    std::unique_ptr<State> state_;
    const std::filesystem::path& name_;
};

}  // namespace limpid::image
