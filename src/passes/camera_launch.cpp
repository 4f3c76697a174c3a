#include "passes/camera_launch.h"

namespace limpid {
namespace {

/// The radical inverse: point `index` of the van der Corput sequence, in [0, 1).
float radicalInverse(uint32_t index, uint32_t base) {
    double result = 0.0;
    for (double digit = 1.0 / base; index > 0; index /= base, digit /= base) result += digit * (index % base);
    return static_cast<float>(result);
}

}  // namespace

vec2 framePoint(uint32_t index, float span) {
    if (index == 0) return vec2(0.0f);
    return span * (vec2(radicalInverse(index, 2), radicalInverse(index, 3)) - 0.5f);
}

}  // namespace limpid
