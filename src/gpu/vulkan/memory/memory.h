// Allocates device memory: from the caller's allocator, or one allocation per resource. There are only tens
// of them, far below any maxMemoryAllocationCount.
#pragma once

#include <cstddef>
#include <memory>

#include "gpu/vulkan/context.h"

namespace limpid::gpu {

struct Memory {
    VkDeviceMemory handle = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;                      ///< in `handle`
    std::byte* mapped = nullptr;                  ///< host address if host-visible (coherent): always mapped
                                                  ///< then
    std::shared_ptr<const void> owner = nullptr;  ///< its deleter frees the memory and subtracts it from
                                                  ///< Context::allocated()
};

enum class MemoryUse {
    Device,    ///< device-local; mapped if that memory is host-visible anyway (lavapipe, integrated GPUs)
    Upload,    ///< written by the host
    Download,  ///< read by the host: cached if possible
};

/// `addressed`: shaders or builds use its device address. Throws Error naming `name` and the size if it
/// exceeds the device's limit or memory runs out.
Memory allocate(const Context& context, const VkMemoryRequirements& requirements, MemoryUse use,
                const std::string& name, bool addressed = false);

/// Returns the next multiple of `alignment`, which must not be 0.
constexpr uint64_t alignUp(uint64_t value, uint64_t alignment) {
    return (value + alignment - 1) / alignment * alignment;
}

}  // namespace limpid::gpu
