// The C interfaces' images in host memory: any strides, one to four floats a pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "limpid/denoise.h"

namespace limpid::denoise {

/// Four floats a pixel; components that the image does not have are 0. Throws UsageError, which says `name`,
/// if it has fewer than `fewest` components or more than four.
std::vector<float> readPixels(const limpid_host_image& image, uint32_t width, uint32_t height,
                              const char* name, uint32_t fewest = 1);

/// Throws UsageError if the image has fewer than `fewest` components or more than four.
void writePixels(const limpid_host_output& image, const std::vector<float>& pixels, uint32_t width,
                 uint32_t height, const char* name, uint32_t fewest = 3);

/// What writePixels() throws, before the pixels are computed.
void checkOutput(const limpid_host_output& image, const char* name, uint32_t fewest = 3);

}  // namespace limpid::denoise
