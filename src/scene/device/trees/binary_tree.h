// Binary trees of boxes: what bvh.h makes its wide nodes of.
//
// Build: I. Wald, "On fast construction of SAH-based bounding volume hierarchies", IEEE RT 2007. Triangles
// that reach into both halves of a node may be split: M. Stich, H. Friedrich, A. Dietrich, "Spatial splits in
// bounding volume hierarchies", HPG 2009.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/progress.h"
#include "base/raw_vector.h"
#include "scene/device/trees/clip.h"
#include "scene/model/aabb.h"

namespace limpid::scene {

struct BinaryNode {
    static constexpr uint32_t inner = ~0u;

    Aabb bounds;
    uint32_t child = 0;          ///< of an inner node: its first child; the second one follows
    uint32_t primitive = inner;  ///< of a leaf

    bool isLeaf() const { return primitive != inner; }
};

/// The root is node 0. The nodes after it are pairs of siblings.
using BinaryTree = RawVector<BinaryNode>;

/// Of any node but the root.
inline uint32_t siblingOf(uint32_t node) {
    return ((node - 1) ^ 1) + 1;
}

/// Below this depth splits halve the number of primitives, so that no tree is deeper than 48 + log2(count).
inline constexpr uint32_t maxSahDepth = 48;

/// A primitive, or a part of it.
struct Reference {
    Aabb bounds;
    uint32_t primitive = 0;
};
using References = RawVector<Reference>;

/// Triangles that may be split.
struct Splits {
    std::span<const Corners> triangles;  ///< by primitive
    std::vector<bool> divisible;         ///< by primitive
    uint32_t most = 0;                   ///< number of references that splits may add
};

/// Builds a tree with a leaf for each reference, of which there is at least one, on all cores: a binned SAH
/// build down to `sahDepth`, halves below. The result depends on the arguments alone. Throws Cancelled as
/// `progress` does.
BinaryTree buildBinaryTree(References references, uint32_t sahDepth, const Splits& splits = {},
                           const Progress& progress = {});

/// The upper nodes of a tree. Each leaf is a part, which is to be built for itself.
struct TreeTop {
    struct Part {
        uint32_t first, count;  ///< of the references
        uint32_t depth;         ///< of its root
    };
    BinaryTree nodes;  ///< `primitive` of a leaf: index of its part
    std::vector<Part> parts;
    References references;
};

/// Builds a tree like buildBinaryTree(), but ends at nodes of up to `partSize` references, at least 2.
TreeTop buildTreeTop(References references, uint32_t sahDepth, uint32_t partSize,
                     const Progress& progress = {});

}  // namespace limpid::scene
