// Points in other spaces.
#pragma once

#include "base/math.h"

namespace limpid::scene {

/// The last row of `matrix` is ignored.
inline vec3 transformPoint(const mat4& matrix, const vec3& point) {
    return vec3(matrix * vec4(point, 1.0f));
}

}  // namespace limpid::scene
