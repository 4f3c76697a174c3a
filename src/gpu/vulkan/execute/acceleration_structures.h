// Acceleration structures of VK_KHR_acceleration_structure: a bottom level per tree of triangles, one top
// level over where the trees stand.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace limpid::gpu {

class Buffer;
class Device;
struct AccelerationStorage;

/// A run of triangles in a texel buffer of RGBA32Float: three texels a triangle, xyz of each a corner.
struct TriangleTree {
    uint32_t first = 0, count = 0;  ///< triangles; none: the tree is never hit
    bool opaque = true;             ///< rays need not ask the any-hit shader
    bool moves = false;             ///< its triangles change: fitted to them by each FrameGraph::rebuild()
};

/// Where a tree stands; the same tree may stand in several places.
struct TreePlacement {
    uint32_t tree = 0;
    std::array<float, 12> toWorld{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  ///< three rows
    bool visible = true;
    bool operator==(const TreePlacement&) const = default;
};

/// Built on the device and compacted. In shaders a hit's gl_InstanceID is the placement and its
/// gl_PrimitiveID counts the triangles of the tree. Move-only; frames under way keep what they need.
class AccelerationStructures {
  public:
    /// `triangles` need not live on. Throws Error if the device has no ray tracing, or naming the limit that
    /// is exceeded.
    AccelerationStructures(Device& device, const std::string& name, const Buffer& triangles,
                           std::span<const TriangleTree> trees, std::span<const TreePlacement> placements);
    ~AccelerationStructures();
    AccelerationStructures(AccelerationStructures&&) noexcept;
    AccelerationStructures& operator=(AccelerationStructures&&) noexcept;

    uint64_t byteCount() const;  ///< on the device, scratch memory included
    uint64_t bytesSavedByCompaction() const;

    const std::shared_ptr<const AccelerationStorage>& storage() const { return storage_; }

  private:
    std::shared_ptr<const AccelerationStorage> storage_;
};

}  // namespace limpid::gpu
