// The names and sizes of device resources, as far as recording needs them. gpu/vulkan has the rest.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gpu/graph/shader_code.h"

namespace limpid::gpu {

class Device;

template <typename T, typename Allocator>
std::span<const std::byte> bytesOf(const std::vector<T, Allocator>& values) {
    return std::as_bytes(std::span<const T>(values));
}

/// Shared by the owning Buffer and the frames in flight that use it, so destroying a Buffer never waits.
struct BufferResource {
    std::string name;
    uint64_t size = 0;             ///< bytes, as requested
    std::optional<Format> format;  ///< for texel buffers

    BufferResource() = default;
    BufferResource(const BufferResource&) = delete;
    BufferResource& operator=(const BufferResource&) = delete;
    virtual ~BufferResource() = default;
};

/// Device memory for storage buffers, texel buffers and uniforms (Device::createStorageBuffer()). Move-only;
/// its destructor frees the memory.
class Buffer {
  public:
    Buffer() = default;
    explicit Buffer(std::shared_ptr<const BufferResource> resource) : resource_(std::move(resource)) {}
    Buffer(Buffer&&) noexcept = default;
    Buffer& operator=(Buffer&&) noexcept = default;

    uint64_t size() const { return resource_ ? resource_->size : 0; }
    /// Empty unless it is a texel buffer.
    std::optional<Format> texelFormat() const { return resource_ ? resource_->format : std::nullopt; }
    explicit operator bool() const { return resource_ != nullptr; }
    const std::shared_ptr<const BufferResource>& resource() const { return resource_; }

  private:
    std::shared_ptr<const BufferResource> resource_;
};

/// A range of triangles in a texel buffer of RGBA32Float: three texels per triangle, xyz of each a vertex.
struct TriangleTree {
    uint32_t first = 0, count = 0;  ///< triangles; count 0: the tree is never hit
    bool opaque = true;             ///< rays skip the any-hit shader
    bool moves = false;             ///< its triangles change: each FrameGraph::rebuild() refits it
};

/// The placement of a tree; a tree may have several.
struct TreePlacement {
    uint32_t tree = 0;
    std::array<float, 12> toWorld{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  ///< three rows
    bool visible = true;
    bool operator==(const TreePlacement&) const = default;
};

/// The acceleration structures' properties that recording needs.
struct StructuresResource {
    std::shared_ptr<const BufferResource> triangles;  ///< the trees are built from these
    std::shared_ptr<const BufferResource> instances;  ///< one record per placement
    std::shared_ptr<const BufferResource> topBuffer;  ///< contains the top level

    virtual ~StructuresResource() = default;
    /// Returns the bytes of a placement's record in `instances`. Throws Error if there is no such placement
    /// or tree.
    using InstanceRecord = std::array<std::byte, 64>;
    virtual InstanceRecord instanceRecord(uint32_t placement, const TreePlacement& where) const = 0;
};

/// Acceleration structures of VK_KHR_acceleration_structure: a bottom level per triangle tree, and one top
/// level over all placements. Built on the device and compacted. In shaders, a hit's gl_InstanceID is the
/// placement and its gl_PrimitiveID counts the triangles of the tree. Move-only; frames in flight keep what
/// they need.
class AccelerationStructures {
  public:
    /// `triangles` may be destroyed afterwards. Throws Error if the device has no ray tracing or a limit is
    /// exceeded, naming the limit.
    AccelerationStructures(Device& device, const std::string& name, const Buffer& triangles,
                           std::span<const TriangleTree> trees, std::span<const TreePlacement> placements);
    AccelerationStructures(AccelerationStructures&&) noexcept = default;
    AccelerationStructures& operator=(AccelerationStructures&&) noexcept = default;

    uint64_t byteCount() const;  ///< on the device, including scratch memory
    uint64_t bytesSavedByCompaction() const;

    const std::shared_ptr<const StructuresResource>& resource() const { return resource_; }

  private:
    std::shared_ptr<const StructuresResource> resource_;
};

}  // namespace limpid::gpu
