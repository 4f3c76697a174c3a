// Bounding volume hierarchies: a binary tree, collapsed to four children a node and quantised.
//
// Collapsing, and quantised nodes: H. Ylitie, T. Karras, S. Laine, "Efficient incoherent ray traversal on
// GPUs through compressed wide BVHs", HPG 2017 (theirs are 8-wide; four fit the 64 bytes of a cache line
// without their packing).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"
#include "base/progress.h"
#include "base/raw_vector.h"
#include "scene/device/trees/binary_tree.h"
#include "scene/model/aabb.h"

namespace limpid::scene {

/// A reference to a node or to a range of primitives, in the format that shaders read
/// (shaders/trace/trace_compute.glsl).
struct BvhRef {
    static constexpr uint32_t leafBit = 1u << 31;
    static constexpr uint32_t countShift = 28;
    static constexpr uint32_t maxLeafSize = 8;
    static constexpr uint32_t maxIndex = (1u << countShift) - 1;

    static uint32_t node(uint32_t index) { return index; }
    static uint32_t leaf(uint32_t first, uint32_t count) {
        return leafBit | (count - 1) << countShift | first;
    }
    static bool isLeaf(uint32_t ref) { return (ref & leafBit) != 0; }
    static uint32_t first(uint32_t ref) { return ref & maxIndex; }
    static uint32_t count(uint32_t ref) { return (ref >> countShift & 7) + 1; }
};

/// Four children. Their boxes are bytes on a grid that starts at `origin` with cells of 2^(exponent - 127). A
/// missing child has lower 255 and upper 0, which no ray hits.
struct BvhNode {
    vec3 origin{0.0f};
    std::array<uint8_t, 4> exponents{};                      ///< x, y, z, unused
    std::array<std::array<uint8_t, 4>, 3> lower{}, upper{};  ///< [axis][child]
    std::array<uint32_t, 2> unused{};
    std::array<uint32_t, 4> children{};  ///< BvhRef

    Aabb childBounds(uint32_t child) const;
    bool hasChild(uint32_t child) const { return lower[0][child] <= upper[0][child]; }
};
static_assert(sizeof(BvhNode) == 64);

struct Bvh {
    RawVector<BvhNode> nodes;   ///< the root is nodes[0]
    RawVector<uint32_t> order;  ///< leaves index into this; it holds the primitives' original indices
    Aabb bounds;
    uint32_t stackSize = 0;  ///< maximum number of stack entries of a depth-first traversal, in any order of
                             ///< children
};

/// Builds a BVH over one box per primitive, on all cores. `maxLeafSize` is 1 to BvhRef::maxLeafSize.
/// `sahDepth` 0 makes the shallowest tree. Throws Error if there are more primitives than a BvhRef can
/// address. Without primitives, returns one node that no ray hits.
Bvh buildBvh(std::span<const Aabb> boxes, uint32_t maxLeafSize, uint32_t sahDepth = maxSahDepth);

/// The same in less memory, since the tree is built part by part: `partSize` is the largest number of
/// primitives in a part, at least 2. Throws Cancelled as `progress` does.
Bvh buildBvhInParts(References references, uint32_t maxLeafSize, uint32_t partSize,
                    const Progress& progress = {});

/// Triangles are split in trees of up to so many.
inline constexpr size_t maxSplitTriangles = size_t{1} << 20;

/// The same over triangles, with up to four in a leaf. Takes longer, and rays are faster: triangles are split
/// where `divisible` (by triangle) allows it, so that `order` may have one of them more than once (but no
/// leaf has), and nodes are moved (reinsertion.h). Throws Cancelled as `progress` does.
Bvh buildTriangleBvh(std::span<const Corners> triangles, const std::vector<bool>& divisible,
                     const Progress& progress = {});
/// The same over the boxes of triangles, none of which is split. Nodes of trees of more than
/// maxSplitTriangles are moved less, those of more than eight million triangles not at all.
Bvh buildTriangleBvh(References triangles, const Progress& progress = {});

/// A child of a node being built.
struct BvhChild {
    uint32_t ref = 0;
    Aabb bounds;
};
/// Returns a node over one to four children.
BvhNode makeBvhNode(std::span<const BvhChild> children);

}  // namespace limpid::scene
