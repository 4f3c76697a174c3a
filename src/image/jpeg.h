// JPEG through libjpeg-turbo. Private to src/image.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "image/png.h"

namespace limpid::image {

/// RGBA. Throws InputError if it is no JPEG, is damaged in any way, claims more pixels than its bytes can
/// hold, or has more scans than a picture needs.
ByteImage decodeJpeg(std::span<const std::byte> bytes, const std::filesystem::path& name);

}  // namespace limpid::image
