#include "gpu/vulkan/memory/transfer.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "gpu/vulkan/check.h"

namespace limpid::gpu {
namespace {

/// The maximum size of staging memory: a scene of gigabytes must not need a second copy of itself.
constexpr uint64_t chunkBytes = uint64_t{64} << 20;

}  // namespace

void beforeCopy(const Context& context, VkCommandBuffer commands) {
    memoryBarrier(context, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                  VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT);
}

void afterCopy(const Context& context, VkCommandBuffer commands) {
    memoryBarrier(context, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
}

Transfer::Transfer(std::shared_ptr<const Context> context)
    : context_(std::move(context)),
      pool_(makeCommandPool(*context_, "transfer")),
      commands_(allocateCommandBuffer(*context_, pool_.get(), "transfer")),
      fence_(makeFence(*context_, "transfer")) {}

void Transfer::run(const std::function<void(VkCommandBuffer)>& record) {
    const std::lock_guard lock(mutex_);
    LIMPID_VK(context_->vk().ResetCommandPool(context_->device(), pool_.get(), 0));
    beginCommands(*context_, commands_);
    beforeCopy(*context_, commands_);
    record(commands_);
    afterCopy(*context_, commands_);
    LIMPID_VK(context_->vk().EndCommandBuffer(commands_));
    context_->submit(commands_, fence_.get());
    waitAndReset(*context_, fence_.get());
}

const BufferStorage& Transfer::staging(BufferUse use, uint64_t bytes) {
    std::shared_ptr<BufferStorage>& buffer = use == BufferUse::Staging ? upload_ : download_;
    if (!buffer || buffer->size < bytes) {
        buffer.reset();
        const char* name = use == BufferUse::Staging ? "upload staging" : "download staging";
        buffer = makeBuffer(context_, name, use, bytes);
    }
    return *buffer;
}

void Transfer::upload(const BufferStorage& buffer, std::span<const std::byte> data) {
    const std::lock_guard lock(mutex_);
    if (data.empty()) return;
    if (buffer.memory.mapped) {
        std::memcpy(buffer.memory.mapped, data.data(), data.size());
        return;
    }
    const BufferStorage& stage = staging(BufferUse::Staging, std::min<uint64_t>(data.size(), chunkBytes));
    for (uint64_t offset = 0; offset < data.size(); offset += chunkBytes) {
        const uint64_t bytes = std::min<uint64_t>(chunkBytes, data.size() - offset);
        std::memcpy(stage.memory.mapped, data.data() + offset, bytes);
        run([&](VkCommandBuffer commands) {
            const VkBufferCopy region{0, offset, bytes};
            context_->vk().CmdCopyBuffer(commands, stage.buffer.get(), buffer.buffer.get(), 1, &region);
        });
    }
}

void Transfer::zero(const BufferStorage& buffer) {
    const std::lock_guard lock(mutex_);
    if (buffer.memory.mapped) {
        std::memset(buffer.memory.mapped, 0, buffer.allocated);
        return;
    }
    run([&](VkCommandBuffer commands) {
        context_->vk().CmdFillBuffer(commands, buffer.buffer.get(), 0, VK_WHOLE_SIZE, 0);
    });
}

void Transfer::download(const BufferStorage& buffer, std::span<std::byte> data) {
    const std::lock_guard lock(mutex_);
    if (data.empty()) return;
    const BufferStorage& stage = staging(BufferUse::Readback, std::min<uint64_t>(data.size(), chunkBytes));
    for (uint64_t offset = 0; offset < data.size(); offset += chunkBytes) {
        const uint64_t bytes = std::min<uint64_t>(chunkBytes, data.size() - offset);
        run([&](VkCommandBuffer commands) {
            const VkBufferCopy region{offset, 0, bytes};
            context_->vk().CmdCopyBuffer(commands, buffer.buffer.get(), stage.buffer.get(), 1, &region);
        });
        std::memcpy(data.data() + offset, stage.memory.mapped, bytes);
    }
}

void Transfer::download(const Image& image, std::span<std::byte> data) {
    const std::lock_guard lock(mutex_);
    if (image.buffer) return download(*image.buffer, data);
    const uint32_t width = image.extent.width, height = image.extent.height;
    const uint64_t rowBytes = uint64_t{width} * bytesPerTexel(image.format);
    const uint32_t rowsPerChunk =
        static_cast<uint32_t>(std::clamp<uint64_t>(chunkBytes / rowBytes, 1, height));
    const BufferStorage& stage = staging(BufferUse::Readback, rowBytes * rowsPerChunk);
    for (uint32_t row = 0; row < height; row += rowsPerChunk) {
        const uint32_t rows = std::min(rowsPerChunk, height - row);
        run([&](VkCommandBuffer commands) {
            VkBufferImageCopy region{};
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.imageOffset = {0, static_cast<int32_t>(row), 0};
            region.imageExtent = {width, rows, 1};
            context_->vk().CmdCopyImageToBuffer(commands, image.image.get(), VK_IMAGE_LAYOUT_GENERAL,
                                                stage.buffer.get(), 1, &region);
        });
        std::memcpy(data.data() + row * rowBytes, stage.memory.mapped, rows * rowBytes);
    }
}

}  // namespace limpid::gpu
