// Buffers on the device.
#pragma once

#include <optional>

#include "gpu/vulkan/memory/memory.h"

namespace limpid::gpu {

/// Shared by the Buffer that owns it and the frames under way that use it: destroying a Buffer never waits.
/// Without a context (tests of recording) it describes a buffer that no device holds.
struct BufferStorage {
    std::shared_ptr<const Context> context;
    Memory memory;
    UniqueBuffer buffer;
    UniqueBufferView view;  ///< of texel buffers
    std::string name;
    uint64_t size = 0;       ///< as asked for
    uint64_t allocated = 0;  ///< of the VkBuffer: a multiple of 4, at least 4
    std::optional<Format> format;
};

struct Buffer::Impl {
    std::shared_ptr<const BufferStorage> storage;
};

/// Triangles are an overlay's vertices and indices. The last four need ray tracing: what acceleration
/// structures lie in, what their builds need, instances of a top level, shader-binding tables.
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

/// Needs ray tracing.
VkDeviceAddress deviceAddress(const BufferStorage& buffer);

/// Throws Error naming the limit that `bytes` exceeds. The content is undefined.
std::shared_ptr<BufferStorage> makeBuffer(std::shared_ptr<const Context> context, const std::string& name,
                                          BufferUse use, uint64_t bytes, std::optional<Format> format = {});

}  // namespace limpid::gpu
