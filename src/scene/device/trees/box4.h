// Boxes in vector registers, for loops that unite very many of them.
#pragma once

#include <cstddef>
#include <cstring>
#include <limits>

#include "scene/device/trees/binary_tree.h"

namespace limpid::scene {

/// GCC's and Clang's vectors: one instruction for four numbers on all their processors that have one.
using Float4 = float __attribute__((vector_size(16)));

/// An Aabb. The fourth numbers mean nothing.
struct Box4 {
    static constexpr float most = std::numeric_limits<float>::max();

    Float4 lower{most, most, most, most};
    Float4 upper{-most, -most, -most, -most};

    void grow(Float4 low, Float4 high) {
        lower = low < lower ? low : lower;
        upper = high > upper ? high : upper;
    }
    void grow(const Box4& other) { grow(other.lower, other.upper); }
    void grow(const Aabb& box) {
        grow(Float4{box.lower.x, box.lower.y, box.lower.z, 0.0f},
             Float4{box.upper.x, box.upper.y, box.upper.z, 0.0f});
    }
    void grow(const Reference& reference) {
        const Box4 box = of(reference);
        grow(box.lower, box.upper);
    }
    /// Reads four numbers each: those behind `lower` are `upper`, and behind that is the primitive.
    static Box4 of(const Reference& reference) {
        static_assert(offsetof(Aabb, lower) == 0 && offsetof(Aabb, upper) == 12 && sizeof(Reference) == 28);
        const auto* const bytes = reinterpret_cast<const std::byte*>(&reference);
        Box4 box;
        std::memcpy(&box.lower, bytes, sizeof(Float4));
        std::memcpy(&box.upper, bytes + sizeof(vec3), sizeof(Float4));
        return box;
    }
    /// As Aabb::center().
    Float4 center() const { return 0.5f * lower + 0.5f * upper; }
    /// As Aabb::halfArea(), of a box that is not empty.
    float halfArea() const {
        const Float4 s = upper - lower;
        return s[0] * s[1] + s[1] * s[2] + s[2] * s[0];
    }
    Aabb aabb() const { return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}}; }
};

}  // namespace limpid::scene
