#include "image/io/rows/limits.h"

#include <fmt/format.h>

#include "base/error.h"

namespace limpid::image {

void checkDimensions(const std::filesystem::path& file, uint64_t width, uint64_t height, uint64_t fileBytes,
                     uint64_t pixelsPerByte, uint64_t most) {
    if (width == 0 || height == 0)
        throw InputError(file, fmt::format("has no pixels ({}x{})", width, height));
    // Divide instead of multiplying: the product of two huge numbers may overflow to a small one.
    if (width > most / height) {
        throw InputError(file,
                         fmt::format("is {}x{} pixels; at most {} pixels are accepted", width, height, most));
    }
    if (width * height / pixelsPerByte > fileBytes) {
        throw InputError(
            file, fmt::format("claims {}x{} pixels, which {} bytes cannot hold", width, height, fileBytes));
    }
}

}  // namespace limpid::image
