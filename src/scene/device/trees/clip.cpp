#include "scene/device/trees/clip.h"

#include <algorithm>

namespace limpid::scene {

/// I. Sutherland, G. Hodgman, "Reentrant polygon clipping", CACM 1974.
Aabb clipped(const Corners& triangle, const Aabb& box) {
    std::array<vec3, 9> polygon, cut;  // each of the six planes adds at most one corner
    size_t count = 3;
    std::copy(triangle.begin(), triangle.end(), polygon.begin());
    for (int plane = 0; plane < 6; ++plane) {
        const int axis = plane / 2;
        const bool upper = plane % 2 != 0;
        const float at = upper ? box.upper[axis] : box.lower[axis];
        const auto inside = [&](const vec3& p) { return upper ? at - p[axis] : p[axis] - at; };
        if (std::all_of(polygon.begin(), polygon.begin() + count,
                        [&](const vec3& p) { return inside(p) >= 0.0f; }))
            continue;
        size_t kept = 0;
        for (size_t i = 0; i < count && kept + 2 <= cut.size(); ++i) {
            const vec3 &a = polygon[i], &b = polygon[(i + 1) % count];
            const float da = inside(a), db = inside(b);
            if (da >= 0.0f) cut[kept++] = a;
            if ((da < 0.0f) == (db < 0.0f)) continue;
            cut[kept] = a + (b - a) * (da / (da - db));
            cut[kept++][axis] = at;
        }
        count = kept;
        std::swap(polygon, cut);
    }
    Aabb part;
    for (size_t i = 0; i < count; ++i) part.grow(polygon[i]);
    if (part.empty()) return box;
    const vec3 margin = 4e-7f * (glm::abs(part.lower) + glm::abs(part.upper) + part.size());
    return {glm::max(part.lower - margin, box.lower), glm::min(part.upper + margin, box.upper)};
}

}  // namespace limpid::scene
