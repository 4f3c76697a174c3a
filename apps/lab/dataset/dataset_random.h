// Random numbers for the clips of a dataset.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/math.h"
#include "scene/builtin/builtin_parts.h"

namespace limpid::cli {

/// Draw only one number per statement: elsewhere the compiler chooses the order.
class ClipRandom {
  public:
    explicit ClipRandom(uint32_t seed) : sequence_(seed) {}

    float between(float least, float most) { return sequence_.next(least, most); }
    bool chance(float share) { return between(0.0f, 1.0f) < share; }
    /// A log-uniform number.
    float logarithmic(float least, float most);
    size_t index(size_t count);  ///< below `count`, which is not 0
    vec3 direction();            ///< unit

  private:
    scene::Sequence sequence_;
};

}  // namespace limpid::cli
