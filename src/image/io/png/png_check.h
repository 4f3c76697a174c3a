// Checks that bytes are a complete, undamaged PNG or JPEG; the decoders show a truncated JPEG as if it were
// complete. Private to src/image.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace limpid::image {

bool looksLikePng(std::span<const std::byte> bytes);
bool looksLikeJpeg(std::span<const std::byte> bytes);

/// Throws InputError unless all chunks up to IEND exist with correct checksums, and the picture has at most
/// maxStreamedPixels; who decodes it whole checks maxPixels.
void checkPng(std::span<const std::byte> bytes, const std::filesystem::path& name);

/// Throws InputError unless the markers lead from start to end of image. Returns true if the decoder must
/// hold all coefficients at once: the file is progressive, or has several scans.
bool checkJpeg(std::span<const std::byte> bytes, const std::filesystem::path& name);

}  // namespace limpid::image
