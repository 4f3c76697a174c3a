// What recording knows of what lies on a device: names and sizes. gpu/vulkan has the rest.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gpu/graph/shader.h"

namespace limpid::gpu {

class Device;

template <typename T>
std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span<const T>(values));
}

/// Shared by the Buffer that owns it and the frames under way that use it: destroying a Buffer never waits.
struct BufferResource {
    std::string name;
    uint64_t size = 0;             ///< bytes, as asked for
    std::optional<Format> format;  ///< of texel buffers

    BufferResource() = default;
    BufferResource(const BufferResource&) = delete;
    BufferResource& operator=(const BufferResource&) = delete;
    virtual ~BufferResource() = default;
};

/// Device memory for storage buffers, texel buffers and uniforms (Device::createStorageBuffer()). Move-only;
/// frees itself.
class Buffer {
  public:
    Buffer() = default;
    explicit Buffer(std::shared_ptr<const BufferResource> resource) : resource_(std::move(resource)) {}
    Buffer(Buffer&&) noexcept = default;
    Buffer& operator=(Buffer&&) noexcept = default;

    uint64_t size() const { return resource_ ? resource_->size : 0; }
    /// Set if it is a texel buffer.
    std::optional<Format> texelFormat() const { return resource_ ? resource_->format : std::nullopt; }
    explicit operator bool() const { return resource_ != nullptr; }
    const std::shared_ptr<const BufferResource>& resource() const { return resource_; }

  private:
    std::shared_ptr<const BufferResource> resource_;
};

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

/// What recording knows of acceleration structures.
struct StructuresResource {
    std::shared_ptr<const BufferResource> triangles;  ///< what the trees are built from
    std::shared_ptr<const BufferResource> instances;  ///< one record per placement
    std::shared_ptr<const BufferResource> topBuffer;  ///< where the top level lies

    virtual ~StructuresResource() = default;
    /// The bytes of a placement's record in `instances`. Throws Error if there is no such placement or tree.
    using InstanceRecord = std::array<std::byte, 64>;
    virtual InstanceRecord instanceRecord(uint32_t placement, const TreePlacement& where) const = 0;
};

/// Acceleration structures of VK_KHR_acceleration_structure: a bottom level per tree of triangles, one top
/// level over where the trees stand. Built on the device and compacted. In shaders a hit's gl_InstanceID is
/// the placement and its gl_PrimitiveID counts the triangles of the tree. Move-only; frames under way keep
/// what they need.
class AccelerationStructures {
  public:
    /// `triangles` need not live on. Throws Error if the device has no ray tracing, or naming the limit that
    /// is exceeded.
    AccelerationStructures(Device& device, const std::string& name, const Buffer& triangles,
                           std::span<const TriangleTree> trees, std::span<const TreePlacement> placements);
    AccelerationStructures(AccelerationStructures&&) noexcept = default;
    AccelerationStructures& operator=(AccelerationStructures&&) noexcept = default;

    uint64_t byteCount() const;  ///< on the device, scratch memory included
    uint64_t bytesSavedByCompaction() const;

    const std::shared_ptr<const StructuresResource>& resource() const { return resource_; }

  private:
    std::shared_ptr<const StructuresResource> resource_;
};

}  // namespace limpid::gpu
