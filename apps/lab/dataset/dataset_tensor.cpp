#include "lab/dataset/dataset_tensor.h"

#include <algorithm>
#include <cmath>

namespace limpid::cli {

neural::Tensor tensorOf(const image::Image& picture) {
    constexpr float largestHalf = 65504.0f;
    const size_t pixels = size_t{picture.width} * picture.height;
    std::vector<float> values(pixels * picture.components);
    for (size_t p = 0; p < pixels; ++p) {
        for (uint32_t c = 0; c < picture.components; ++c) {
            const float value = picture.pixels[p * picture.components + c];
            values[c * pixels + p] =
                std::isfinite(value) ? std::clamp(value, -largestHalf, largestHalf) : 0.0f;
        }
    }
    return neural::makeTensor(neural::ElementType::Float16,
                              {picture.components, picture.height, picture.width}, values);
}

image::Image distancesOf(const image::LayeredImage& layers) {
    image::Image depth = layers.get("depth", "Z");
    for (float& z : depth.pixels) z = z < 1e9f ? z : 0.0f;
    return depth;
}

}  // namespace limpid::cli
