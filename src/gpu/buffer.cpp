#include "gpu/buffer.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "gpu/check.h"
#include "gpu/format.h"

namespace limpid::gpu {
namespace {

VkBufferUsageFlags usageOf(BufferUse use) {
    constexpr VkBufferUsageFlags copies = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    switch (use) {
        case BufferUse::Texel:
            return VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT | copies;
        case BufferUse::Storage:
            return VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | copies;
        case BufferUse::Uniform:
            return VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
        case BufferUse::Staging:
        case BufferUse::Readback:
            return copies;
    }
    return copies;
}

MemoryUse memoryOf(BufferUse use) {
    if (use == BufferUse::Texel || use == BufferUse::Storage) return MemoryUse::Device;
    return use == BufferUse::Readback ? MemoryUse::Download : MemoryUse::Upload;
}

void checkLimit(const Context& context, const std::string& name, std::string_view limit, uint64_t maximum,
                uint64_t asked, std::string_view unit) {
    if (asked <= maximum) return;
    throw Error(fmt::format("buffer '{}' needs {} {}, more than {} = {} of {}", name, asked, unit, limit,
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
    LIMPID_VK(vkCreateBufferView(context.device(), &info, nullptr, &view));
    UniqueBufferView owned(context.device(), view);
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
    info.usage = usageOf(use);
    VkBuffer handle = VK_NULL_HANDLE;
    LIMPID_VK(vkCreateBuffer(context->device(), &info, nullptr, &handle));
    storage->buffer = UniqueBuffer(context->device(), handle);
    context->setName(handle, name);
    VkMemoryRequirements requirements{};
    vkGetBufferMemoryRequirements(context->device(), handle, &requirements);
    storage->memory = allocate(*context, requirements, memoryOf(use), name);
    LIMPID_VK(vkBindBufferMemory(context->device(), handle, storage->memory.handle.get(), 0));
    if (format) storage->view = makeView(*context, *storage);
    storage->context = std::move(context);
    return storage;
}

Buffer::Buffer() = default;
Buffer::Buffer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;
Buffer::~Buffer() = default;

uint64_t Buffer::size() const {
    return impl_ ? impl_->storage->size : 0;
}

std::optional<Format> Buffer::texelFormat() const {
    return impl_ ? impl_->storage->format : std::nullopt;
}

}  // namespace limpid::gpu
