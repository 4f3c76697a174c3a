#include "gpu/present/graphics_pipeline.h"

#include <array>

#include "gpu/vulkan/check.h"

namespace limpid::gpu {
namespace {

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
    return over;
}

}  // namespace

UniquePipeline makePipeline(const Context& context, const GraphicsPipeline& wanted) {
    const UniqueShaderModule vertex = makeModule(context, wanted.vertex),
                             fragment = makeModule(context, wanted.fragment);
    const std::array stages{stageOf(VK_SHADER_STAGE_VERTEX_BIT, vertex),
                            stageOf(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
    const VkVertexInputBindingDescription vertices{0, wanted.vertexBytes, VK_VERTEX_INPUT_RATE_VERTEX};
    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    input.vertexBindingDescriptionCount = wanted.vertexBytes > 0 ? 1 : 0;
    input.pVertexBindingDescriptions = &vertices;
    input.vertexAttributeDescriptionCount = static_cast<uint32_t>(wanted.attributes.size());
    input.pVertexAttributeDescriptions = wanted.attributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.lineWidth = 1.0f;
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineColorBlendAttachmentState over =
        wanted.blends ? blendOver() : VkPipelineColorBlendAttachmentState{};
    over.colorWriteMask = 0xF;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = 1;
    blend.pAttachments = &over;
    const VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = dynamicStates;
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &wanted.target;
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
    info.layout = wanted.layout;
    VkPipeline raw = VK_NULL_HANDLE;
    LIMPID_VK(
        context.vk().CreateGraphicsPipelines(context.device(), VK_NULL_HANDLE, 1, &info, nullptr, &raw));
    context.setName(raw, wanted.name);
    return {context.vk(), raw};
}

SmallLayout makeSmallLayout(const Context& context, VkDescriptorType type, uint32_t pushBytes) {
    SmallLayout made;
    VkDescriptorSetLayoutBinding binding{};
    binding.descriptorType = type;
    binding.descriptorCount = 1;
    binding.stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT;
    VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    setInfo.bindingCount = 1;
    setInfo.pBindings = &binding;
    VkDescriptorSetLayout rawSets = VK_NULL_HANDLE;
    LIMPID_VK(context.vk().CreateDescriptorSetLayout(context.device(), &setInfo, nullptr, &rawSets));
    made.sets = UniqueSetLayout(context.vk(), rawSets);

    const VkPushConstantRange range{drawingStages, 0, pushBytes};
    VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts = &rawSets;
    layoutInfo.pushConstantRangeCount = 1;
    layoutInfo.pPushConstantRanges = &range;
    VkPipelineLayout rawPipelines = VK_NULL_HANDLE;
    LIMPID_VK(context.vk().CreatePipelineLayout(context.device(), &layoutInfo, nullptr, &rawPipelines));
    made.pipelines = UniquePipelineLayout(context.vk(), rawPipelines);

    const VkDescriptorPoolSize size{type, 1};
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    LIMPID_VK(context.vk().CreateDescriptorPool(context.device(), &poolInfo, nullptr, &pool));
    made.pool = UniqueDescriptorPool(context.vk(), pool);
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    info.descriptorPool = pool;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &rawSets;
    LIMPID_VK(context.vk().AllocateDescriptorSets(context.device(), &info, &made.set));
    return made;
}

void beginDrawing(const Context& context, VkCommandBuffer commands, VkImageView target, VkImageLayout layout,
                  Extent extent, VkPipeline pipeline, const SmallLayout& with) {
    VkRenderingAttachmentInfo attachment{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    attachment.imageView = target;
    attachment.imageLayout = layout;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea = {{0, 0}, {extent.width, extent.height}};
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &attachment;
    context.vk().CmdBeginRendering(commands, &rendering);
    context.vk().CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    context.vk().CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, with.pipelines.get(), 0, 1,
                                       &with.set, 0, nullptr);
    const VkViewport viewport{0.0f, 0.0f, static_cast<float>(extent.width), static_cast<float>(extent.height),
                              0.0f, 1.0f};
    context.vk().CmdSetViewport(commands, 0, 1, &viewport);
    context.vk().CmdSetScissor(commands, 0, 1, &rendering.renderArea);
}

}  // namespace limpid::gpu
