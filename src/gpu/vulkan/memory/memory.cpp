#include "gpu/vulkan/memory/memory.h"

#include <atomic>
#include <functional>
#include <optional>

#include "base/error.h"
#include "base/text/bytes_text.h"
#include "base/text/format.h"
#include "gpu/vulkan/check.h"

namespace limpid::gpu {
namespace {

constexpr VkMemoryPropertyFlags hostCoherent =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

std::optional<uint32_t> findType(const VkPhysicalDeviceMemoryProperties& memory, uint32_t allowed,
                                 VkMemoryPropertyFlags flags) {
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        // Device-coherent memory (AMD) requires a feature that Limpid does not enable.
        if (memory.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD) continue;
        if ((allowed >> i & 1) && (memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
    }
    return std::nullopt;
}

/// Drivers order the types so that the first suitable one has the fewest additional properties.
uint32_t chooseType(const Context& context, uint32_t allowed, MemoryUse use) {
    const VkPhysicalDeviceMemoryProperties& memory = context.memoryProperties();
    std::optional<uint32_t> type;
    if (use == MemoryUse::Device) {
        type = findType(memory, allowed, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
        if (!type) type = findType(memory, allowed, 0);
    } else {
        if (use == MemoryUse::Download) {
            type = findType(memory, allowed, hostCoherent | VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
        }
        if (!type) type = findType(memory, allowed, hostCoherent);
    }
    if (!type) throw Error("the device has no memory of a fitting type");
    return *type;
}

/// Counts the bytes as allocated until the owner is destroyed, which calls `release`.
std::shared_ptr<const void> ownerOf(const Context& context, uint64_t bytes, std::function<void()> release) {
    const std::shared_ptr<std::atomic<uint64_t>> total = context.allocated();
    *total += bytes;
    return {static_cast<const void*>(nullptr), [total, bytes, release = std::move(release)](const void*) {
                release();
                *total -= bytes;
            }};
}

[[noreturn]] void failToAllocate(const Context& context, VkResult result, uint64_t bytes,
                                 const std::string& name) {
    throw OutOfMemory(formatText("{} on {}: {} for '{}' could not be allocated ({})", resultMeaning(result),
                                 context.info().name, bytesText(bytes), name, resultName(result)));
}

bool isOutOfMemory(VkResult result) {
    return result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY;
}

Memory allocateByHooks(const Context& context, const VkMemoryRequirements& requirements, MemoryUse use,
                       const std::string& name) {
    const MemoryHooks& hooks = context.memoryHooks();
    const VkMemoryPropertyFlags properties =
        use == MemoryUse::Device ? VkMemoryPropertyFlags{VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT} : hostCoherent;
    MemoryHooks::Block block;
    const VkResult result = hooks.allocate(requirements, properties, name.c_str(), block);
    if (result != VK_SUCCESS) failToAllocate(context, result, requirements.size, name);
    // Owned before it is checked, so that it is given back.
    Memory memory{block.memory, block.offset, static_cast<std::byte*>(block.mapped),
                  ownerOf(context, requirements.size, [free = hooks.free, block] { free(block); })};
    if (use != MemoryUse::Device && !block.mapped)
        throw Error(formatText("the caller's allocator gave '{}' memory that the host cannot see", name));
    return memory;
}

}  // namespace

Memory allocate(const Context& context, const VkMemoryRequirements& requirements, MemoryUse use,
                const std::string& name, bool addressed) {
    if (context.memoryHooks().allocate) return allocateByHooks(context, requirements, use, name);
    if (requirements.size > context.maxAllocation()) {
        throw Error(formatText("'{}' needs {} bytes, more than maxMemoryAllocationSize = {} of {}", name,
                               requirements.size, context.maxAllocation(), context.info().name));
    }
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.allocationSize = requirements.size;
    info.memoryTypeIndex = chooseType(context, requirements.memoryTypeBits, use);
    VkMemoryAllocateFlagsInfo flagsInfo{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    flagsInfo.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    if (addressed) info.pNext = &flagsInfo;
    const DeviceFunctions& vk = context.vk();
    VkDeviceMemory handle = VK_NULL_HANDLE;
    const VkResult result = vk.AllocateMemory(context.device(), &info, nullptr, &handle);
    if (isOutOfMemory(result)) failToAllocate(context, result, requirements.size, name);
    LIMPID_VK(result);
    Memory memory{handle, 0, nullptr, ownerOf(context, requirements.size, [&vk, handle] {
                      vk.FreeMemory(vk.device, handle, nullptr);
                  })};
    context.setName(handle, name);
    const VkMemoryPropertyFlags flags =
        context.memoryProperties().memoryTypes[info.memoryTypeIndex].propertyFlags;
    if ((flags & hostCoherent) == hostCoherent) {
        void* mapped = nullptr;
        LIMPID_VK(vk.MapMemory(context.device(), handle, 0, VK_WHOLE_SIZE, 0, &mapped));
        memory.mapped = static_cast<std::byte*>(mapped);
    }
    return memory;
}

}  // namespace limpid::gpu
