#include "gpu/vulkan/memory/buffer.h"

#include <algorithm>

#include "base/error.h"
#include "base/text/format.h"
#include "gpu/vulkan/check.h"
#include "gpu/vulkan/memory/format.h"

namespace limpid::gpu {
namespace {

VkBufferUsageFlags usageOf(const Context& context, BufferUse use) {
    constexpr VkBufferUsageFlags address = VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    constexpr VkBufferUsageFlags input =
        VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR | address;
    constexpr VkBufferUsageFlags copies = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    switch (use) {
        case BufferUse::Texel:
            // Triangles are stored in one, and acceleration structures are built from it.
            return VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT | copies | (context.hasRayTracing() ? input : 0);
        case BufferUse::Storage:
            return VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | copies;
        case BufferUse::Uniform:
            return VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
        case BufferUse::Staging:
        case BufferUse::Readback:
            return copies;
        case BufferUse::Triangles:
            return VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
        case BufferUse::Structure:
            return VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR | address;
        case BufferUse::Scratch:
            return VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | address;
        case BufferUse::Instances:
            return input | copies;
        case BufferUse::ShaderTable:
            return VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR | address;
    }
    return copies;
}

MemoryUse memoryOf(BufferUse use) {
    switch (use) {
        case BufferUse::Readback:
            return MemoryUse::Download;
        case BufferUse::Uniform:
        case BufferUse::Staging:
        case BufferUse::Triangles:
        case BufferUse::ShaderTable:
            return MemoryUse::Upload;
        default:
            return MemoryUse::Device;
    }
}

void checkLimit(const Context& context, const std::string& name, std::string_view limit, uint64_t maximum,
                uint64_t asked, std::string_view unit) {
    if (asked <= maximum) return;
    throw Error(formatText("buffer '{}' needs {} {}, more than {} = {} of {}", name, asked, unit, limit,
                           maximum, context.info().name));
}

void checkLimits(const Context& context, const std::string& name, BufferUse use, uint64_t bytes,
                 std::optional<Format> format) {
    if (format) {
        checkLimit(context, name, "maxTexelBufferElements", context.limits().maxTexelBufferElements,
                   bytes / bytesPerTexel(*format), "texels");
    }
    if (use == BufferUse::Storage) {
        checkLimit(context, name, "maxStorageBufferRange", context.limits().maxStorageBufferRange, bytes,
                   "bytes");
    }
    const bool allocationIsSmaller = context.maxAllocation() <= context.maxBufferBytes();
    checkLimit(context, name, allocationIsSmaller ? "maxMemoryAllocationSize" : "maxBufferSize",
               context.maxBufferBytes(), bytes, "bytes");
}

UniqueBufferView makeView(const Context& context, const BufferStorage& storage) {
    VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    info.buffer = storage.buffer.get();
    info.format = toVulkan(*storage.format);
    info.range = VK_WHOLE_SIZE;
    VkBufferView view = VK_NULL_HANDLE;
    LIMPID_VK(context.vk().CreateBufferView(context.device(), &info, nullptr, &view));
    UniqueBufferView owned(context.vk(), view);
    context.setName(view, storage.name);
    return owned;
}

}  // namespace

std::shared_ptr<BufferStorage> makeBuffer(std::shared_ptr<const Context> context, const std::string& name,
                                          BufferUse use, uint64_t bytes, std::optional<Format> format) {
    checkLimits(*context, name, use, bytes, format);
    auto storage = std::make_shared<BufferStorage>();
    storage->name = name;
    storage->size = bytes;
    storage->format = format;
    storage->allocated = std::max<uint64_t>(4, (bytes + 3) / 4 * 4);

    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = storage->allocated;
    info.usage = usageOf(*context, use);
    VkBuffer handle = VK_NULL_HANDLE;
    LIMPID_VK(context->vk().CreateBuffer(context->device(), &info, nullptr, &handle));
    storage->buffer = UniqueBuffer(context->vk(), handle);
    context->setName(handle, name);
    VkMemoryRequirements requirements{};
    context->vk().GetBufferMemoryRequirements(context->device(), handle, &requirements);
    const bool addressed = (info.usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0;
    storage->memory = allocate(*context, requirements, memoryOf(use), name, addressed);
    LIMPID_VK(context->vk().BindBufferMemory(context->device(), handle, storage->memory.handle,
                                             storage->memory.offset));
    if (format) storage->view = makeView(*context, *storage);
    storage->context = std::move(context);
    return storage;
}

VkDeviceAddress deviceAddress(const BufferStorage& buffer) {
    VkBufferDeviceAddressInfo info{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    info.buffer = buffer.buffer.get();
    return buffer.context->vk().GetBufferDeviceAddress(buffer.context->device(), &info);
}

}  // namespace limpid::gpu
