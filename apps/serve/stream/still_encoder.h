// Single pictures: JPEG while something moves, PNG for what rests.
#pragma once

#include <cstddef>
#include <vector>

#include "studio/picture.h"

namespace limpid::serve {

/// `quality`: 1 to 100. Throws Error if libjpeg-turbo cannot.
std::vector<std::byte> encodeJpeg(const studio::Picture& picture, int quality);

/// Lossless; without alpha.
std::vector<std::byte> encodeStill(const studio::Picture& picture);

}  // namespace limpid::serve
