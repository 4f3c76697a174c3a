#include "scene/obj/obj_polygon.h"

#include <cmath>
#include <numeric>

namespace limpid::scene {
namespace {

constexpr size_t maxEarCorners = 256;

using Triangles = std::vector<std::array<uint32_t, 3>>;

/// Newell's normal: correct for any nearly planar polygon, including concave ones.
vec3 newellNormal(std::span<const vec3> corners) {
    vec3 normal(0.0f);
    for (size_t i = 0; i < corners.size(); ++i) {
        normal += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    }
    return normal;
}

/// Projects the polygon along the dominant axis of its normal, counter-clockwise.
std::vector<vec2> project(std::span<const vec3> corners) {
    const vec3 normal = newellNormal(corners);
    const vec3 size = glm::abs(normal);
    const int drop = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
    int u = (drop + 1) % 3;
    int v = (drop + 2) % 3;
    if (normal[drop] < 0.0f) std::swap(u, v);
    std::vector<vec2> flat;
    for (const vec3& corner : corners) flat.emplace_back(corner[u], corner[v]);
    return flat;
}

float turn(const vec2& a, const vec2& b, const vec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool isEar(const std::vector<vec2>& flat, const std::vector<uint32_t>& left, size_t i) {
    const size_t n = left.size();
    const uint32_t a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
    if (!(turn(flat[a], flat[b], flat[c]) > 0.0f)) return false;
    for (const uint32_t p : left) {
        if (p == a || p == b || p == c) continue;
        // A corner at the same position as one of the ear's corners does not block it.
        if (flat[p] == flat[a] || flat[p] == flat[b] || flat[p] == flat[c]) continue;
        if (turn(flat[a], flat[b], flat[p]) >= 0.0f && turn(flat[b], flat[c], flat[p]) >= 0.0f &&
            turn(flat[c], flat[a], flat[p]) >= 0.0f) {
            return false;
        }
    }
    return true;
}

void fan(const std::vector<uint32_t>& left, Triangles& triangles) {
    for (size_t i = 1; i + 1 < left.size(); ++i) triangles.push_back({left[0], left[i], left[i + 1]});
}

bool isConvex(const std::vector<vec2>& flat) {
    const size_t n = flat.size();
    for (size_t i = 0; i < n; ++i) {
        if (turn(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) < 0.0f) return false;
    }
    return true;
}

}  // namespace

std::vector<std::array<uint32_t, 3>> triangulate(std::span<const vec3> corners) {
    Triangles triangles;
    std::vector<uint32_t> left(corners.size());
    std::iota(left.begin(), left.end(), 0u);
    const std::vector<vec2> flat = project(corners);
    if (corners.size() > 3 && corners.size() <= maxEarCorners && !isConvex(flat)) {
        for (size_t i = 0, tried = 0; left.size() > 3 && tried < left.size();) {
            i %= left.size();
            if (!isEar(flat, left, i)) {
                ++i;
                ++tried;
                continue;
            }
            const size_t n = left.size();
            triangles.push_back({left[(i + n - 1) % n], left[i], left[(i + 1) % n]});
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
            tried = 0;
        }
    }
    fan(left, triangles);
    return triangles;
}

}  // namespace limpid::scene
