#include "gpu/present/overlay_drawer.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "base/error.h"
#include "gpu/vulkan/check.h"
#include "overlay.frag.h"
#include "overlay.vert.h"

namespace limpid::gpu {
namespace {

struct Push {
    float perPixel[2];
    uint32_t texture[2];
};

/// Draws triangles in pixels of the window, blended over the existing content.
UniquePipeline makeOverlayPipeline(const Context& context, VkPipelineLayout layout, VkFormat target) {
    const std::array<VkVertexInputAttributeDescription, 3> attributes{{{0, 0, VK_FORMAT_R32G32_SFLOAT, 0},
                                                                       {1, 0, VK_FORMAT_R32G32_SFLOAT, 8},
                                                                       {2, 0, VK_FORMAT_R8G8B8A8_UNORM, 16}}};
    return makePipeline(context, {.name = "overlay",
                                  .layout = layout,
                                  .vertex = shaders::overlay_vert,
                                  .fragment = shaders::overlay_frag,
                                  .target = target,
                                  .attributes = attributes,
                                  .vertexBytes = sizeof(OverlayVertex),
                                  .blends = true});
}

}  // namespace

OverlayDrawer::OverlayDrawer(std::shared_ptr<const Context> from)
    : context_(std::move(from)),
      layout_(makeSmallLayout(*context_, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, sizeof(Push))) {}

void OverlayDrawer::setTarget(VkFormat format) {
    pipeline_ = makeOverlayPipeline(*context_, layout_.pipelines.get(), format);
}

void OverlayDrawer::setTexture(Transfer& transfer, Extent size, std::span<const uint32_t> texels) {
    if (size.width == 0 || texels.size() != size_t{size.width} * size.height)
        throw Error("an overlay's texture has another size than its texels");
    context_->waitIdle();
    texture_ = makeBuffer(context_, "overlay texture", BufferUse::Storage, texels.size_bytes());
    transfer.upload(*texture_, std::as_bytes(texels));
    textureExtent_ = size;
    const VkDescriptorBufferInfo buffer{texture_->buffer.get(), 0, texture_->allocated};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = layout_.set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = &buffer;
    context_->vk().UpdateDescriptorSets(context_->device(), 1, &write, 0, nullptr);
}

void OverlayDrawer::upload(Triangles& triangles, const Overlay& overlay) const {
    triangles.indicesAt = overlay.vertices.size_bytes();
    const uint64_t bytes = triangles.indicesAt + overlay.indices.size_bytes();
    if (bytes == 0) return;
    if (!triangles.buffer || triangles.buffer->size < bytes) {
        triangles.buffer.reset();
        triangles.buffer = makeBuffer(context_, "overlay triangles", BufferUse::Triangles, 2 * bytes);
    }
    std::memcpy(triangles.buffer->memory.mapped, overlay.vertices.data(), triangles.indicesAt);
    std::memcpy(triangles.buffer->memory.mapped + triangles.indicesAt, overlay.indices.data(),
                overlay.indices.size_bytes());
}

void OverlayDrawer::draw(VkCommandBuffer commands, const Triangles& triangles, const Overlay& overlay,
                         VkImageView target, VkImageLayout layout, Extent extent) const {
    if (!texture_ || overlay.draws.empty()) return;
    beginDrawing(*context_, commands, target, layout, extent, pipeline_.get(), layout_);
    const Push push{{2.0f / static_cast<float>(extent.width), 2.0f / static_cast<float>(extent.height)},
                    {textureExtent_.width, textureExtent_.height}};
    context_->vk().CmdPushConstants(commands, layout_.pipelines.get(), drawingStages, 0, sizeof(push), &push);
    const VkBuffer buffer = triangles.buffer->buffer.get();
    const VkDeviceSize start = 0;
    context_->vk().CmdBindVertexBuffers(commands, 0, 1, &buffer, &start);
    context_->vk().CmdBindIndexBuffer(commands, buffer, triangles.indicesAt, VK_INDEX_TYPE_UINT16);
    for (const OverlayDraw& draw : overlay.draws) {
        const auto pixel = [](float value, uint32_t most) {
            return static_cast<int32_t>(std::clamp(value, 0.0f, static_cast<float>(most)));
        };
        const int32_t left = pixel(draw.left, extent.width), right = pixel(draw.right, extent.width);
        const int32_t top = pixel(draw.top, extent.height), bottom = pixel(draw.bottom, extent.height);
        if (right <= left || bottom <= top) continue;
        const VkRect2D scissor{{left, top},
                               {static_cast<uint32_t>(right - left), static_cast<uint32_t>(bottom - top)}};
        context_->vk().CmdSetScissor(commands, 0, 1, &scissor);
        context_->vk().CmdDrawIndexed(commands, draw.indexCount, 1, draw.firstIndex,
                                      static_cast<int32_t>(draw.firstVertex), 0);
    }
    context_->vk().CmdEndRendering(commands);
}

}  // namespace limpid::gpu
