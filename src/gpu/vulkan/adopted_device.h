// A Vulkan device of the caller's: Limpid creates its objects on it, and neither the device nor a queue.
#pragma once

#include "base/message.h"
#include "gpu/vulkan/vk.h"

namespace limpid::gpu {

/// Memory from the caller's allocator. Both functions are called by the thread that calls Limpid, and throw
/// nothing.
struct MemoryHooks {
    struct Block {
        VkDeviceMemory memory = VK_NULL_HANDLE;
        VkDeviceSize offset = 0;
        void* mapped = nullptr;  ///< where the host sees the block; null if it does not
        void* handle = nullptr;  ///< of the caller's, for free()
    };
    void* user = nullptr;
    /// A block of a memory type of `requirements` with all of `properties`. Null: Limpid allocates by itself,
    /// one VkDeviceMemory for each image and buffer.
    VkResult (*allocate)(void* user, const VkMemoryRequirements* requirements,
                         VkMemoryPropertyFlags properties, const char* name, Block* block) = nullptr;
    void (*free)(void* user, const Block* block) = nullptr;
};

/// The device must have been made with Vulkan 1.3 and the features that requiredFeatures() names.
struct AdoptedDevice {
    PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    uint32_t queueFamily = 0;  ///< that the command buffers are for; it must compute
    bool debugUtils = false;  ///< VK_EXT_debug_utils is enabled on the instance: objects and passes get names
    MemoryHooks memory;
    MessageCallback messages;
};

}  // namespace limpid::gpu
