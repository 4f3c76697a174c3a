// Buffers on the device.
#pragma once

#include <optional>

#include "gpu/graph/resources.h"
#include "gpu/vulkan/memory/memory.h"

namespace limpid::gpu {

/// The real type of every BufferResource, except in tests that only record.
struct BufferStorage : BufferResource {
    std::shared_ptr<const Context> context;
    Memory memory;
    UniqueBuffer buffer;
    UniqueBufferView view;   ///< for texel buffers
    uint64_t allocated = 0;  ///< bytes of the VkBuffer: a multiple of 4, at least 4
};

inline const BufferStorage& storageOf(const BufferResource& resource) {
    return static_cast<const BufferStorage&>(resource);
}

/// Triangles holds an overlay's vertices and indices. The last four need ray tracing: storage of acceleration
/// structures, input and scratch of their builds, instances of a top level, shader-binding tables.
enum class BufferUse {
    Texel,
    Storage,
    Uniform,
    Staging,
    Readback,
    Triangles,
    Structure,
    Scratch,
    Instances,
    ShaderTable
};

/// Requires ray tracing.
VkDeviceAddress deviceAddress(const BufferStorage& buffer);

/// Throws Error naming the limit if `bytes` exceeds one. The content is undefined.
std::shared_ptr<BufferStorage> makeBuffer(std::shared_ptr<const Context> context, const std::string& name,
                                          BufferUse use, uint64_t bytes, std::optional<Format> format = {});

}  // namespace limpid::gpu
