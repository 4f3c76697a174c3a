#include "gpu/vulkan/memory/memory.h"

#include <fmt/format.h>

#include <atomic>
#include <optional>

#include "base/error.h"
#include "base/text/bytes_text.h"
#include "gpu/vulkan/check.h"

namespace limpid::gpu {
namespace {

constexpr VkMemoryPropertyFlags hostCoherent =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

std::optional<uint32_t> findType(const VkPhysicalDeviceMemoryProperties& memory, uint32_t allowed,
                                 VkMemoryPropertyFlags flags) {
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        // Device-coherent memory (AMD) needs a feature that Limpid does not switch on.
        if (memory.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD) continue;
        if ((allowed >> i & 1) && (memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
    }
    return std::nullopt;
}

/// The types are ordered by the driver: the first that has what is needed has the least besides.
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

/// Adds them for as long as the result lives.
std::shared_ptr<const void> countBytes(const std::shared_ptr<std::atomic<uint64_t>>& total, uint64_t bytes) {
    *total += bytes;
    return {static_cast<const void*>(nullptr), [total, bytes](const void*) { *total -= bytes; }};
}

}  // namespace

Memory allocate(const Context& context, const VkMemoryRequirements& requirements, MemoryUse use,
                const std::string& name, bool addressed) {
    if (requirements.size > context.maxAllocation()) {
        throw Error(fmt::format("'{}' needs {} bytes, more than maxMemoryAllocationSize = {} of {}", name,
                                requirements.size, context.maxAllocation(), context.info().name));
    }
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.allocationSize = requirements.size;
    info.memoryTypeIndex = chooseType(context, requirements.memoryTypeBits, use);
    VkMemoryAllocateFlagsInfo flagsInfo{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    flagsInfo.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    if (addressed) info.pNext = &flagsInfo;
    VkDeviceMemory handle = VK_NULL_HANDLE;
    const VkResult result = vkAllocateMemory(context.device(), &info, nullptr, &handle);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) {
        throw Error(fmt::format("{} on {}: {} for '{}' could not be allocated ({})", resultMeaning(result),
                                context.info().name, bytesText(requirements.size), name, resultName(result)));
    }
    LIMPID_VK(result);
    Memory memory{UniqueMemory(context.device(), handle), nullptr,
                  countBytes(context.allocated(), requirements.size)};
    context.setName(handle, name);
    const VkMemoryPropertyFlags flags =
        context.memoryProperties().memoryTypes[info.memoryTypeIndex].propertyFlags;
    if ((flags & hostCoherent) == hostCoherent) {
        void* mapped = nullptr;
        LIMPID_VK(vkMapMemory(context.device(), handle, 0, VK_WHOLE_SIZE, 0, &mapped));
        memory.mapped = static_cast<std::byte*>(mapped);
    }
    return memory;
}

}  // namespace limpid::gpu
