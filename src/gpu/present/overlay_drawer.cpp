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

UniqueShaderModule makeModule(const Context& context, std::span<const uint32_t> words) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = words.size_bytes();
    info.pCode = words.data();
    VkShaderModule module = VK_NULL_HANDLE;
    LIMPID_VK(context.vk().CreateShaderModule(context.device(), &info, nullptr, &module));
    return {context.vk(), module};
}

VkPipelineShaderStageCreateInfo stageOf(VkShaderStageFlagBits stage, const UniqueShaderModule& module) {
    VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage = stage;
    info.module = module.get();
    info.pName = "main";
    return info;
}

VkPipelineColorBlendAttachmentState blendOver() {
    VkPipelineColorBlendAttachmentState over{};
    over.blendEnable = VK_TRUE;
    over.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    over.dstColorBlendFactor = over.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    over.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    over.colorWriteMask = 0xF;
    return over;
}

/// Draws triangles in pixels of the window, blended over the existing content.
UniquePipeline makeOverlayPipeline(const Context& context, VkPipelineLayout layout, VkFormat target) {
    const UniqueShaderModule vertex = makeModule(context, shaders::overlay_vert),
                             fragment = makeModule(context, shaders::overlay_frag);
    const std::array stages{stageOf(VK_SHADER_STAGE_VERTEX_BIT, vertex),
                            stageOf(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
    const VkVertexInputBindingDescription vertices{0, sizeof(OverlayVertex), VK_VERTEX_INPUT_RATE_VERTEX};
    const std::array<VkVertexInputAttributeDescription, 3> attributes{{{0, 0, VK_FORMAT_R32G32_SFLOAT, 0},
                                                                       {1, 0, VK_FORMAT_R32G32_SFLOAT, 8},
                                                                       {2, 0, VK_FORMAT_R8G8B8A8_UNORM, 16}}};
    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    input.vertexBindingDescriptionCount = 1;
    input.pVertexBindingDescriptions = &vertices;
    input.vertexAttributeDescriptionCount = static_cast<uint32_t>(attributes.size());
    input.pVertexAttributeDescriptions = attributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.lineWidth = 1.0f;
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    const VkPipelineColorBlendAttachmentState over = blendOver();
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = 1;
    blend.pAttachments = &over;
    const VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = dynamicStates;
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &target;
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    info.pNext = &rendering;
    info.stageCount = 2;
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = layout;
    VkPipeline raw = VK_NULL_HANDLE;
    LIMPID_VK(
        context.vk().CreateGraphicsPipelines(context.device(), VK_NULL_HANDLE, 1, &info, nullptr, &raw));
    context.setName(raw, "overlay");
    return {context.vk(), raw};
}

}  // namespace

OverlayDrawer::OverlayDrawer(std::shared_ptr<const Context> from, VkFormat target)
    : context_(std::move(from)) {
    makeLayout();
    makeDescriptors();
    pipeline_ = makeOverlayPipeline(*context_, layout_.get(), target);
}

void OverlayDrawer::makeLayout() {
    VkDescriptorSetLayoutBinding binding{};
    binding.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    binding.descriptorCount = 1;
    binding.stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT;
    VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    setInfo.bindingCount = 1;
    setInfo.pBindings = &binding;
    VkDescriptorSetLayout rawSet = VK_NULL_HANDLE;
    LIMPID_VK(context_->vk().CreateDescriptorSetLayout(context_->device(), &setInfo, nullptr, &rawSet));
    setLayout_ = UniqueSetLayout(context_->vk(), rawSet);

    const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                    sizeof(Push)};
    VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts = &rawSet;
    layoutInfo.pushConstantRangeCount = 1;
    layoutInfo.pPushConstantRanges = &range;
    VkPipelineLayout rawLayout = VK_NULL_HANDLE;
    LIMPID_VK(context_->vk().CreatePipelineLayout(context_->device(), &layoutInfo, nullptr, &rawLayout));
    layout_ = UniquePipelineLayout(context_->vk(), rawLayout);
}

void OverlayDrawer::makeDescriptors() {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    LIMPID_VK(context_->vk().CreateDescriptorPool(context_->device(), &poolInfo, nullptr, &pool));
    descriptors_ = UniqueDescriptorPool(context_->vk(), pool);
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    info.descriptorPool = pool;
    info.descriptorSetCount = 1;
    const VkDescriptorSetLayout raw = setLayout_.get();
    info.pSetLayouts = &raw;
    LIMPID_VK(context_->vk().AllocateDescriptorSets(context_->device(), &info, &set_));
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
    write.dstSet = set_;
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
                         VkImageView target, Extent extent) const {
    if (!texture_ || overlay.draws.empty()) return;
    VkRenderingAttachmentInfo attachment{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    attachment.imageView = target;
    attachment.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea = {{0, 0}, {extent.width, extent.height}};
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &attachment;
    context_->vk().CmdBeginRendering(commands, &rendering);
    context_->vk().CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.get());
    context_->vk().CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1,
                                         &set_, 0, nullptr);
    const VkViewport viewport{0.0f, 0.0f, static_cast<float>(extent.width), static_cast<float>(extent.height),
                              0.0f, 1.0f};
    context_->vk().CmdSetViewport(commands, 0, 1, &viewport);
    const Push push{{2.0f / viewport.width, 2.0f / viewport.height},
                    {textureExtent_.width, textureExtent_.height}};
    context_->vk().CmdPushConstants(commands, layout_.get(),
                                    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                    sizeof(push), &push);
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
