#include "scene/device/lights/lamps.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <unordered_map>

namespace limpid::scene {
namespace {

/// Sets that can be joined, with paths halved on the way (R. E. Tarjan, J. van Leeuwen, "Worst-case analysis
/// of set union algorithms", JACM 1984).
class DisjointSets {
  public:
    explicit DisjointSets(size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0u); }

    uint32_t find(uint32_t member) {
        while (parents_[member] != member) {
            parents_[member] = parents_[parents_[member]];
            member = parents_[member];
        }
        return member;
    }

    void join(uint32_t a, uint32_t b) {
        a = find(a);
        b = find(b);
        parents_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<uint32_t> parents_;
};

/// An edge by its ends' positions, in an order that does not depend on the triangle's, and the triangle's
/// material.
using Edge = std::array<uint32_t, 7>;

Edge edgeBetween(const vec3& a, const vec3& b, uint32_t material) {
    const auto bitsOf = [](const vec3& v) {
        // Adding 0 makes -0 equal to 0.
        return std::array{std::bit_cast<uint32_t>(v.x + 0.0f), std::bit_cast<uint32_t>(v.y + 0.0f),
                          std::bit_cast<uint32_t>(v.z + 0.0f)};
    };
    const auto ends = std::minmax({bitsOf(a), bitsOf(b)});
    return {ends.first[0],  ends.first[1],  ends.first[2], ends.second[0],
            ends.second[1], ends.second[2], material};
}

struct EdgeHash {
    size_t operator()(const Edge& edge) const {
        uint64_t hash = 1469598103934665603u;  // FNV-1a by words
        for (const uint32_t word : edge) hash = (hash ^ word) * 1099511628211u;
        return static_cast<size_t>(hash ^ hash >> 32);
    }
};

}  // namespace

std::vector<uint32_t> lampsOf(const Mesh& mesh, std::span<const uint32_t> triangles) {
    DisjointSets sets(triangles.size());
    std::unordered_map<Edge, uint32_t, EdgeHash> firstWith;
    firstWith.reserve(2 * triangles.size());
    for (uint32_t i = 0; i < triangles.size(); ++i) {
        const uint32_t material = mesh.materialSlots.empty() ? 0 : mesh.materialSlots[triangles[i]];
        const uint32_t* corners = &mesh.indices[3 * size_t{triangles[i]}];
        for (int k = 0; k < 3; ++k) {
            const Edge edge =
                edgeBetween(mesh.positions[corners[k]], mesh.positions[corners[(k + 1) % 3]], material);
            const auto [found, isNew] = firstWith.try_emplace(edge, i);
            if (!isNew) sets.join(i, found->second);
        }
    }
    // A set's representative is its least member, so it has its number before the others ask for it.
    std::vector<uint32_t> numbers(triangles.size());
    uint32_t count = 0;
    for (uint32_t i = 0; i < triangles.size(); ++i) {
        const uint32_t representative = sets.find(i);
        numbers[i] = representative == i ? count++ : numbers[representative];
    }
    return numbers;
}

}  // namespace limpid::scene
