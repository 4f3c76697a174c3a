#include "gpu/vulkan/memory/image.h"

#include <algorithm>

#include "base/error.h"
#include "base/text/format.h"
#include "gpu/vulkan/check.h"
#include "gpu/vulkan/memory/format.h"

namespace limpid::gpu {
namespace {

UniqueImageView makeView(const Context& context, VkImage image, Format format, const std::string& name) {
    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.image = image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = toVulkan(format);
    info.subresourceRange = wholeImage();
    VkImageView view = VK_NULL_HANDLE;
    LIMPID_VK(context.vk().CreateImageView(context.device(), &info, nullptr, &view));
    UniqueImageView owned(context.vk(), view);
    context.setName(view, name);
    return owned;
}

Image makeBufferImage(std::shared_ptr<const Context> context, const std::string& name, Format format,
                      Extent extent) {
    Image image;
    image.format = format;
    image.extent = extent;
    const uint64_t bytes = uint64_t{extent.width} * extent.height * bytesPerTexel(format);
    image.buffer = makeBuffer(context, name, BufferUse::Storage, bytes);
    image.context = std::move(context);
    return image;
}

}  // namespace

VkImageSubresourceRange wholeImage() {
    return {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
}

Image makeImage(std::shared_ptr<const Context> context, const std::string& name, Format format, Extent extent,
                Backing backing, VkImageUsageFlags moreUsage) {
    if (backing == Backing::Buffer) return makeBufferImage(std::move(context), name, format, extent);
    const uint32_t maximum = context->limits().maxImageDimension2D;
    if (std::max(extent.width, extent.height) > maximum) {
        throw Error(formatText("image '{}' of {} x {} pixels exceeds maxImageDimension2D = {} of {}", name,
                               extent.width, extent.height, maximum, context->info().name));
    }
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = toVulkan(format);
    info.extent = {extent.width, extent.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                 VK_IMAGE_USAGE_TRANSFER_DST_BIT | moreUsage;
    VkImage handle = VK_NULL_HANDLE;
    LIMPID_VK(context->vk().CreateImage(context->device(), &info, nullptr, &handle));

    Image image;
    image.format = format;
    image.extent = extent;
    image.image = UniqueImage(context->vk(), handle);
    context->setName(handle, name);
    VkMemoryRequirements requirements{};
    context->vk().GetImageMemoryRequirements(context->device(), handle, &requirements);
    image.memory = allocate(*context, requirements, MemoryUse::Device, name);
    LIMPID_VK(
        context->vk().BindImageMemory(context->device(), handle, image.memory.handle, image.memory.offset));
    image.view = makeView(*context, handle, format, name);
    image.context = std::move(context);
    return image;
}

}  // namespace limpid::gpu
