#include "denoise/api/host_pixels.h"

#include <cstring>

#include "base/error.h"
#include "base/text/format.h"

namespace limpid::denoise {
namespace {

/// Strides in bytes, with their defaults.
struct Layout {
    size_t pixel, row;
};

void checkComponents(uint32_t components, const char* name, uint32_t fewest) {
    if (components < fewest || components > 4)
        throw UsageError(
            formatText("the image '{}' has {} components: {} to 4 are possible", name, components, fewest));
}

template <typename HostImage>
Layout layoutOf(const HostImage& image, uint32_t width) {
    const size_t pixel = image.pixel_stride ? image.pixel_stride : image.components * sizeof(float);
    return {pixel, image.row_stride ? image.row_stride : width * pixel};
}

}  // namespace

std::vector<float> readPixels(const limpid_host_image& image, uint32_t width, uint32_t height,
                              const char* name, uint32_t fewest) {
    checkComponents(image.components, name, fewest);
    const Layout layout = layoutOf(image, width);
    std::vector<float> pixels(size_t{4} * width * height);
    const auto* bytes = reinterpret_cast<const std::byte*>(image.data);
    for (size_t y = 0; y < height; ++y)
        for (size_t x = 0; x < width; ++x)
            std::memcpy(&pixels[4 * (y * width + x)], bytes + y * layout.row + x * layout.pixel,
                        image.components * sizeof(float));
    return pixels;
}

void writePixels(const limpid_host_output& image, const std::vector<float>& pixels, uint32_t width,
                 uint32_t height, const char* name, uint32_t fewest) {
    checkOutput(image, name, fewest);
    const Layout layout = layoutOf(image, width);
    auto* bytes = reinterpret_cast<std::byte*>(image.data);
    for (size_t y = 0; y < height; ++y)
        for (size_t x = 0; x < width; ++x)
            std::memcpy(bytes + y * layout.row + x * layout.pixel, &pixels[4 * (y * width + x)],
                        image.components * sizeof(float));
}

void checkOutput(const limpid_host_output& image, const char* name, uint32_t fewest) {
    checkComponents(image.components, name, fewest);
}

}  // namespace limpid::denoise
