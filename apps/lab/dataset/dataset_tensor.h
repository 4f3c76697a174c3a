// Pictures as tensors of a dataset.
#pragma once

#include "image/image.h"
#include "neural/tensor_file.h"

namespace limpid::cli {

/// Converts interleaved components to planar channels of halves. Values beyond the range of halves are
/// clamped, and those that are not finite become 0.
neural::Tensor tensorOf(const image::Image& picture);

/// In files, depth is 1e10 where the ray misses; here it becomes 0.
image::Image distancesOf(const image::LayeredImage& layers);

}  // namespace limpid::cli
