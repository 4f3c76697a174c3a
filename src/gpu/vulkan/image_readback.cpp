#include "gpu/vulkan/image_readback.h"

#include "base/error.h"
#include "gpu/graph/frame_graph_impl.h"
#include "gpu/vulkan/check.h"
#include "gpu/vulkan/device_impl.h"
#include "gpu/vulkan/memory/transfer.h"

namespace limpid::gpu {

struct ImageReadback::Impl {
    explicit Impl(Device& on)
        : device(on),
          context(on.impl().context),
          pool(makeCommandPool(*context, "readback")),
          commands(allocateCommandBuffer(*context, pool.get(), "readback")),
          fence(makeFence(*context, "readback")) {}
    ~Impl() {
        if (pending) context->waitIdleNoThrow();
    }

    void recordCopy(const Image& image) {
        if (image.buffer) {
            const VkBufferCopy region{0, 0, bytes};
            context->vk().CmdCopyBuffer(commands, image.buffer->buffer.get(), buffer->buffer.get(), 1,
                                        &region);
            return;
        }
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {image.extent.width, image.extent.height, 1};
        context->vk().CmdCopyImageToBuffer(commands, image.image.get(), VK_IMAGE_LAYOUT_GENERAL,
                                           buffer->buffer.get(), 1, &region);
    }
    void record(const Image& image) {
        LIMPID_VK(context->vk().ResetCommandPool(context->device(), pool.get(), 0));
        beginCommands(*context, commands);
        beforeCopy(*context, commands);
        recordCopy(image);
        afterCopy(*context, commands);
        LIMPID_VK(context->vk().EndCommandBuffer(commands));
    }

    Device& device;
    std::shared_ptr<const Context> context;
    UniqueCommandPool pool;
    VkCommandBuffer commands;
    UniqueFence fence;
    std::shared_ptr<BufferStorage> buffer;
    size_t bytes = 0;
    bool pending = false;
};

ImageReadback::ImageReadback(Device& device) : impl_(std::make_unique<Impl>(device)) {
    if (!impl_->context->submits()) throw Error("nothing can be read back from an adopted device");
}

ImageReadback::~ImageReadback() = default;
ImageReadback::ImageReadback(ImageReadback&&) noexcept = default;

void ImageReadback::start(FrameGraph& graph, ImageHandle handle) {
    Impl& self = *impl_;
    wait();
    const Image& image = graph.downloadable(self.device, handle);
    self.bytes = size_t{image.extent.width} * image.extent.height * bytesPerTexel(image.format);
    if (!self.buffer || self.buffer->size < self.bytes) {
        self.buffer.reset();
        self.buffer = makeBuffer(self.context, "readback", BufferUse::Readback, self.bytes);
    }
    self.record(image);
    self.context->submit(self.commands, self.fence.get());
    self.pending = true;
}

void ImageReadback::wait() {
    if (!impl_->pending) return;
    waitAndReset(*impl_->context, impl_->fence.get());
    impl_->pending = false;
}

std::span<const std::byte> ImageReadback::pixels() {
    wait();
    if (!impl_->buffer) return {};
    return {impl_->buffer->memory.mapped, impl_->bytes};
}

}  // namespace limpid::gpu
