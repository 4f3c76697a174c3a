#include "gpu/present/surface_encoder.h"

#include "surface.frag.h"
#include "surface.vert.h"

namespace limpid::gpu {
namespace {

struct EncoderPush {
    uint32_t encoding;
    float paperWhite, peak;
};

}  // namespace

SurfaceEncoder::SurfaceEncoder(std::shared_ptr<const Context> context, const SurfaceFormat& surface)
    : context_(std::move(context)), encoding_(surface.encoding) {
    layout_ = makeSmallLayout(*context_, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, sizeof(EncoderPush));
    pipeline_ = makePipeline(*context_, {.name = "surface encoder",
                                         .layout = layout_.pipelines.get(),
                                         .vertex = shaders::surface_vert,
                                         .fragment = shaders::surface_frag,
                                         .target = surface.vulkan.format});
}

void SurfaceEncoder::resize(Extent extent) {
    composed_.reset();
    composed_ = makeImage(context_, "composed window", Format::RGBA16Float, extent, Backing::Image,
                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    const VkDescriptorImageInfo image{VK_NULL_HANDLE, composed_->view.get(), VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = layout_.set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    write.pImageInfo = &image;
    context_->vk().UpdateDescriptorSets(context_->device(), 1, &write, 0, nullptr);
}

void SurfaceEncoder::encode(VkCommandBuffer commands, VkImageView target, VkImageLayout layout,
                            const HighRange& range) const {
    beginDrawing(*context_, commands, target, layout, composed_->extent, pipeline_.get(), layout_);
    const EncoderPush push{static_cast<uint32_t>(encoding_), range.paperWhite, range.peak};
    context_->vk().CmdPushConstants(commands, layout_.pipelines.get(), drawingStages, 0, sizeof(push), &push);
    context_->vk().CmdDraw(commands, 3, 1, 0, 0);
    context_->vk().CmdEndRendering(commands);
}

}  // namespace limpid::gpu
