// A Vulkan device that the caller owns. Limpid creates its objects on it, but no device or queue of its own.
#pragma once

#include <functional>

#include "base/message.h"
#include "gpu/vulkan/vk.h"

namespace limpid::gpu {

/// Uses the caller's memory allocator. Both functions are called on the thread that calls Limpid, and must
/// not throw.
struct MemoryHooks {
    struct Block {
        VkDeviceMemory memory = VK_NULL_HANDLE;
        VkDeviceSize offset = 0;
        void* mapped = nullptr;  ///< host address of the block; null if it is not host-visible
        void* handle = nullptr;  ///< the caller's own value, passed to free()
    };
    /// Sets `block` to a block of a memory type allowed by `requirements` that has all of `properties`. Null:
    /// Limpid allocates memory itself, one VkDeviceMemory for each image and buffer.
    std::function<VkResult(const VkMemoryRequirements& requirements, VkMemoryPropertyFlags properties,
                           const char* name, Block& block)>
        allocate;
    std::function<void(const Block& block)> free;
};

/// The device must have been created with Vulkan 1.3 and the features listed by requiredFeatures().
struct AdoptedDevice {
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    uint32_t queueFamily = 0;  ///< of the command buffers; it must support compute
    bool debugUtils = false;   ///< VK_EXT_debug_utils is enabled on the instance, so objects and passes get
                               ///< names
    MemoryHooks memory;
    MessageCallback messages;
};

}  // namespace limpid::gpu
