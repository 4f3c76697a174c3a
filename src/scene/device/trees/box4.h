// Boxes in vector registers, for loops that unite very many of them.
#pragma once

#include <cstddef>
#include <cstring>
#include <limits>

#include "scene/model/aabb.h"

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
    /// Reads four numbers each: those of `lower` and the next one, and those of `upper` and the one before.
    static Box4 of(const Aabb& aabb) {
        static_assert(offsetof(Aabb, lower) == 0 && offsetof(Aabb, upper) == 12 && sizeof(Aabb) == 24);
        const auto* const bytes = reinterpret_cast<const std::byte*>(&aabb);
        Box4 box;
        std::memcpy(&box.lower, bytes, sizeof(Float4));
        std::memcpy(&box.upper, bytes + sizeof(Aabb) - sizeof(Float4), sizeof(Float4));
        box.upper = __builtin_shufflevector(box.upper, box.upper, 1, 2, 3, 0);
        return box;
    }
    /// As Aabb::center().
    Float4 center() const { return 0.5f * lower + 0.5f * upper; }
    /// As Aabb::halfArea(); infinite for an empty box, so that no split with one is chosen.
    float halfArea() const {
        const Float4 s = upper - lower;
        return s[0] * s[1] + s[1] * s[2] + s[2] * s[0];
    }
    Aabb aabb() const { return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}}; }
};

}  // namespace limpid::scene
