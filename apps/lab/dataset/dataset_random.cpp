#include "lab/dataset/dataset_random.h"

#include <algorithm>
#include <cmath>

namespace limpid::cli {

float ClipRandom::logarithmic(float least, float most) {
    return std::exp(between(std::log(least), std::log(most)));
}

size_t ClipRandom::index(size_t count) {
    return std::min(static_cast<size_t>(between(0.0f, static_cast<float>(count))), count - 1);
}

vec3 ClipRandom::direction() {
    const float y = between(-1.0f, 1.0f);
    const float angle = between(0.0f, 2.0f * pi);
    const float across = std::sqrt(std::max(1.0f - y * y, 0.0f));
    return {across * std::cos(angle), y, across * std::sin(angle)};
}

}  // namespace limpid::cli
