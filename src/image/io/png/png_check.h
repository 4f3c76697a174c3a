// Whether the bytes are a whole, undamaged PNG or JPEG: the decoders show a JPEG that was cut
// off as if it were complete. Private to src/image.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace limpid::image {

bool looksLikePng(std::span<const std::byte> bytes);
bool looksLikeJpeg(std::span<const std::byte> bytes);

/// Throws InputError unless all chunks up to IEND are there, their checksums are right, and the size that is
/// stated is one that image/io/limits.h accepts.
void checkPng(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// Throws InputError unless the markers lead from start to end of image. Returns whether the decoder holds
/// all coefficients at once: the file is progressive, or has several scans.
bool checkJpeg(std::span<const std::byte> bytes, const std::filesystem::path& name);

}  // namespace limpid::image
