#include "gpu/presenter.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "base/error.h"
#include "gpu/check.h"
#include "gpu/device_impl.h"
#include "gpu/frame_executor.h"
#include "gpu/frame_graph_impl.h"
#include "overlay.frag.h"
#include "overlay.vert.h"

namespace limpid::gpu {
namespace {

struct Push {
    float perPixel[2];
    uint32_t texture[2];
};

/// What one picture under way owns.
struct Slot {
    UniqueCommandPool pool;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    UniqueFence fence;
    UniqueSemaphore acquired;
    std::shared_ptr<BufferStorage> triangles;  ///< vertices, then indices
    uint64_t indicesAt = 0;
    bool submitted = false;
};

UniqueSemaphore makeSemaphore(const Context& context) {
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    LIMPID_VK(vkCreateSemaphore(context.device(), &info, nullptr, &semaphore));
    return {context.device(), semaphore};
}

UniqueShaderModule makeModule(const Context& context, const ShaderCode& code) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = code.words.size_bytes();
    info.pCode = code.words.data();
    VkShaderModule module = VK_NULL_HANDLE;
    LIMPID_VK(vkCreateShaderModule(context.device(), &info, nullptr, &module));
    return {context.device(), module};
}

void imageBarrier(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to,
                  VkPipelineStageFlags2 fromStage, VkAccessFlags2 fromAccess, VkPipelineStageFlags2 toStage,
                  VkAccessFlags2 toAccess) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = fromStage;
    barrier.srcAccessMask = fromAccess;
    barrier.dstStageMask = toStage;
    barrier.dstAccessMask = toAccess;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = wholeImage();
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

VkOffset3D corner(Extent extent) {
    return {static_cast<int32_t>(extent.width), static_cast<int32_t>(extent.height), 1};
}

}  // namespace

struct Presenter::Impl {
    Impl(std::shared_ptr<const Context> from, const std::function<uint64_t(void*)>& makeSurface);
    ~Impl();

    bool present(const Image& picture, Extent window, const Overlay& overlay);
    void setTexture(Transfer& transfer, Extent extent, std::span<const uint32_t> texels);

    VkSurfaceFormatKHR chooseFormat() const;
    void makePipeline();
    void makeDescriptors();
    bool makeSwapchain(Extent window);
    void dropSwapchain();
    void upload(Slot& slot, const Overlay& overlay) const;
    void record(const Slot& slot, uint32_t index, const Image& picture, const Overlay& overlay) const;
    void drawOverlay(const Slot& slot, uint32_t index, const Overlay& overlay) const;
    void submit(Slot& slot, uint32_t index) const;

    std::shared_ptr<const Context> context;
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    VkSurfaceFormatKHR format{};
    UniqueSetLayout setLayout;
    UniquePipelineLayout layout;
    UniquePipeline pipeline;
    UniqueDescriptorPool descriptors;
    VkDescriptorSet set = VK_NULL_HANDLE;
    std::shared_ptr<BufferStorage> texture;
    Extent textureExtent;

    UniqueSwapchain swapchain;
    Extent extent;   ///< of the swapchain
    Extent madeFor;  ///< the window's
    std::vector<VkImage> images;
    std::vector<UniqueImageView> views;
    std::vector<UniqueSemaphore> rendered;  ///< by image
    std::array<Slot, 2> slots;
    uint64_t presented = 0;
};

Presenter::Impl::Impl(std::shared_ptr<const Context> from, const std::function<uint64_t(void*)>& makeSurface)
    : context(std::move(from)) {
    if (!context->presents())
        throw Error(context->info().name + " cannot show pictures in windows; 'limpid render' writes files");
    surface = reinterpret_cast<VkSurfaceKHR>(makeSurface(context->instance()));
    VkBool32 supported = VK_FALSE;
    LIMPID_VK(vkGetPhysicalDeviceSurfaceSupportKHR(context->physicalDevice(), context->queueFamily(), surface,
                                                   &supported));
    if (!supported)
        throw Error(context->info().name +
                    " cannot show pictures in this window; 'limpid render' writes files");
    format = chooseFormat();
    makePipeline();
    makeDescriptors();
    for (Slot& slot : slots) {
        slot.pool = makeCommandPool(*context, "presenter commands");
        slot.commands = allocateCommandBuffer(*context, slot.pool.get(), "presenter commands");
        slot.fence = makeFence(*context, "presenter fence");
        slot.acquired = makeSemaphore(*context);
    }
}

Presenter::Impl::~Impl() {
    context->waitIdleNoThrow();
    dropSwapchain();
    if (surface != VK_NULL_HANDLE) vkDestroySurfaceKHR(context->instance(), surface, nullptr);
}

/// Pictures are encoded already: no format that encodes once more.
VkSurfaceFormatKHR Presenter::Impl::chooseFormat() const {
    uint32_t count = 0;
    LIMPID_VK(vkGetPhysicalDeviceSurfaceFormatsKHR(context->physicalDevice(), surface, &count, nullptr));
    std::vector<VkSurfaceFormatKHR> formats(count);
    LIMPID_VK(
        vkGetPhysicalDeviceSurfaceFormatsKHR(context->physicalDevice(), surface, &count, formats.data()));
    for (const VkFormat wanted :
         {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_A2B10G10R10_UNORM_PACK32}) {
        for (const VkSurfaceFormatKHR& candidate : formats) {
            if (candidate.format == wanted && candidate.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR)
                return candidate;
        }
    }
    throw Error("this window takes no 8-bit sRGB pictures from " + context->info().name);
}

void Presenter::Impl::makePipeline() {
    VkDescriptorSetLayoutBinding binding{};
    binding.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    binding.descriptorCount = 1;
    binding.stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT;
    VkDescriptorSetLayoutCreateInfo setInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    setInfo.bindingCount = 1;
    setInfo.pBindings = &binding;
    VkDescriptorSetLayout rawSet = VK_NULL_HANDLE;
    LIMPID_VK(vkCreateDescriptorSetLayout(context->device(), &setInfo, nullptr, &rawSet));
    setLayout = UniqueSetLayout(context->device(), rawSet);

    const VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                    sizeof(Push)};
    VkPipelineLayoutCreateInfo layoutInfo{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layoutInfo.setLayoutCount = 1;
    layoutInfo.pSetLayouts = &rawSet;
    layoutInfo.pushConstantRangeCount = 1;
    layoutInfo.pPushConstantRanges = &range;
    VkPipelineLayout rawLayout = VK_NULL_HANDLE;
    LIMPID_VK(vkCreatePipelineLayout(context->device(), &layoutInfo, nullptr, &rawLayout));
    layout = UniquePipelineLayout(context->device(), rawLayout);

    const UniqueShaderModule vertex = makeModule(*context, shaders::overlay_vert),
                             fragment = makeModule(*context, shaders::overlay_frag);
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
    for (VkPipelineShaderStageCreateInfo& stage : stages) {
        stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stage.pName = "main";
    }
    stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
    stages[0].module = vertex.get();
    stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    stages[1].module = fragment.get();
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
    VkPipelineColorBlendAttachmentState over{};
    over.blendEnable = VK_TRUE;
    over.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    over.dstColorBlendFactor = over.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    over.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
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
    rendering.pColorAttachmentFormats = &format.format;
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
    info.layout = rawLayout;
    VkPipeline raw = VK_NULL_HANDLE;
    LIMPID_VK(vkCreateGraphicsPipelines(context->device(), VK_NULL_HANDLE, 1, &info, nullptr, &raw));
    pipeline = UniquePipeline(context->device(), raw);
    context->setName(raw, "overlay");
}

void Presenter::Impl::makeDescriptors() {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    VkDescriptorPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    poolInfo.maxSets = 1;
    poolInfo.poolSizeCount = 1;
    poolInfo.pPoolSizes = &size;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    LIMPID_VK(vkCreateDescriptorPool(context->device(), &poolInfo, nullptr, &pool));
    descriptors = UniqueDescriptorPool(context->device(), pool);
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    info.descriptorPool = pool;
    info.descriptorSetCount = 1;
    const VkDescriptorSetLayout raw = setLayout.get();
    info.pSetLayouts = &raw;
    LIMPID_VK(vkAllocateDescriptorSets(context->device(), &info, &set));
}

void Presenter::Impl::setTexture(Transfer& transfer, Extent size, std::span<const uint32_t> texels) {
    if (size.width == 0 || texels.size() != size_t{size.width} * size.height)
        throw Error("an overlay's texture has another size than its texels");
    context->waitIdle();
    texture = makeBuffer(context, "overlay texture", BufferUse::Storage, texels.size_bytes());
    transfer.upload(*texture, std::as_bytes(texels));
    textureExtent = size;
    const VkDescriptorBufferInfo buffer{texture->buffer.get(), 0, texture->allocated};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    write.pBufferInfo = &buffer;
    vkUpdateDescriptorSets(context->device(), 1, &write, 0, nullptr);
}

void Presenter::Impl::dropSwapchain() {
    rendered.clear();
    views.clear();
    images.clear();
    swapchain = {};
}

/// False if the window has no pixels.
bool Presenter::Impl::makeSwapchain(Extent window) {
    context->waitIdle();
    VkSurfaceCapabilitiesKHR can{};
    LIMPID_VK(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(context->physicalDevice(), surface, &can));
    const bool free = can.currentExtent.width == UINT32_MAX;  // the swapchain decides
    const Extent wanted = free ? window : Extent{can.currentExtent.width, can.currentExtent.height};
    extent = {std::clamp(wanted.width, can.minImageExtent.width, can.maxImageExtent.width),
              std::clamp(wanted.height, can.minImageExtent.height, can.maxImageExtent.height)};
    madeFor = window;
    if (wanted.width == 0 || wanted.height == 0 || extent.width == 0 || extent.height == 0) return false;
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface;
    info.minImageCount = std::max(3u, can.minImageCount);
    if (can.maxImageCount != 0) info.minImageCount = std::min(info.minImageCount, can.maxImageCount);
    info.imageFormat = format.format;
    info.imageColorSpace = format.colorSpace;
    info.imageExtent = {extent.width, extent.height};
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain.get();
    VkSwapchainKHR raw = VK_NULL_HANDLE;
    LIMPID_VK(vkCreateSwapchainKHR(context->device(), &info, nullptr, &raw));
    dropSwapchain();
    swapchain = UniqueSwapchain(context->device(), raw);
    uint32_t count = 0;
    LIMPID_VK(vkGetSwapchainImagesKHR(context->device(), raw, &count, nullptr));
    images.resize(count);
    LIMPID_VK(vkGetSwapchainImagesKHR(context->device(), raw, &count, images.data()));
    for (const VkImage image : images) {
        VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
        view.image = image;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = format.format;
        view.subresourceRange = wholeImage();
        VkImageView made = VK_NULL_HANDLE;
        LIMPID_VK(vkCreateImageView(context->device(), &view, nullptr, &made));
        views.emplace_back(context->device(), made);
        rendered.push_back(makeSemaphore(*context));
    }
    return true;
}

void Presenter::Impl::upload(Slot& slot, const Overlay& overlay) const {
    slot.indicesAt = overlay.vertices.size_bytes();
    const uint64_t bytes = slot.indicesAt + overlay.indices.size_bytes();
    if (bytes == 0) return;
    if (!slot.triangles || slot.triangles->size < bytes) {
        slot.triangles.reset();
        slot.triangles = makeBuffer(context, "overlay triangles", BufferUse::Triangles, 2 * bytes);
    }
    std::memcpy(slot.triangles->memory.mapped, overlay.vertices.data(), slot.indicesAt);
    std::memcpy(slot.triangles->memory.mapped + slot.indicesAt, overlay.indices.data(),
                overlay.indices.size_bytes());
}

void Presenter::Impl::record(const Slot& slot, uint32_t index, const Image& picture,
                             const Overlay& overlay) const {
    const VkCommandBuffer commands = slot.commands;
    LIMPID_VK(vkResetCommandPool(context->device(), slot.pool.get(), 0));
    beginCommands(commands);
    // The frame that made the picture was submitted to the same queue.
    memoryBarrier(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
    imageBarrier(commands, images[index], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_PIPELINE_STAGE_2_BLIT_BIT, 0, VK_PIPELINE_STAGE_2_BLIT_BIT,
                 VK_ACCESS_2_TRANSFER_WRITE_BIT);
    VkImageBlit blit{};
    blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    blit.srcOffsets[1] = corner(picture.extent);
    blit.dstOffsets[1] = corner(extent);
    vkCmdBlitImage(commands, picture.image.get(), VK_IMAGE_LAYOUT_GENERAL, images[index],
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit,
                   picture.extent == extent ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
    imageBarrier(commands, images[index], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_BLIT_BIT,
                 VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                 VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
    if (texture && !overlay.draws.empty()) drawOverlay(slot, index, overlay);
    imageBarrier(commands, images[index], VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                 VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_2_NONE, 0);
    LIMPID_VK(vkEndCommandBuffer(commands));
}

void Presenter::Impl::drawOverlay(const Slot& slot, uint32_t index, const Overlay& overlay) const {
    const VkCommandBuffer commands = slot.commands;
    VkRenderingAttachmentInfo attachment{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    attachment.imageView = views[index].get();
    attachment.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea = {{0, 0}, {extent.width, extent.height}};
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &attachment;
    vkCmdBeginRendering(commands, &rendering);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.get());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout.get(), 0, 1, &set, 0, nullptr);
    const VkViewport viewport{0.0f, 0.0f, static_cast<float>(extent.width), static_cast<float>(extent.height),
                              0.0f, 1.0f};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    const Push push{{2.0f / viewport.width, 2.0f / viewport.height},
                    {textureExtent.width, textureExtent.height}};
    vkCmdPushConstants(commands, layout.get(), VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                       sizeof(push), &push);
    const VkBuffer buffer = slot.triangles->buffer.get();
    const VkDeviceSize start = 0;
    vkCmdBindVertexBuffers(commands, 0, 1, &buffer, &start);
    vkCmdBindIndexBuffer(commands, buffer, slot.indicesAt, VK_INDEX_TYPE_UINT16);
    for (const OverlayDraw& draw : overlay.draws) {
        const auto pixel = [](float value, uint32_t most) {
            return static_cast<int32_t>(std::clamp(value, 0.0f, static_cast<float>(most)));
        };
        const int32_t left = pixel(draw.left, extent.width), right = pixel(draw.right, extent.width);
        const int32_t top = pixel(draw.top, extent.height), bottom = pixel(draw.bottom, extent.height);
        if (right <= left || bottom <= top) continue;
        const VkRect2D scissor{{left, top},
                               {static_cast<uint32_t>(right - left), static_cast<uint32_t>(bottom - top)}};
        vkCmdSetScissor(commands, 0, 1, &scissor);
        vkCmdDrawIndexed(commands, draw.indexCount, 1, draw.firstIndex,
                         static_cast<int32_t>(draw.firstVertex), 0);
    }
    vkCmdEndRendering(commands);
}

void Presenter::Impl::submit(Slot& slot, uint32_t index) const {
    VkSemaphoreSubmitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO},
        signal{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    wait.semaphore = slot.acquired.get();
    wait.stageMask = VK_PIPELINE_STAGE_2_BLIT_BIT;
    signal.semaphore = rendered[index].get();
    signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = slot.commands;
    VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    info.waitSemaphoreInfoCount = info.signalSemaphoreInfoCount = info.commandBufferInfoCount = 1;
    info.pWaitSemaphoreInfos = &wait;
    info.pSignalSemaphoreInfos = &signal;
    info.pCommandBufferInfos = &commands;
    LIMPID_VK(vkQueueSubmit2(context->queue(), 1, &info, slot.fence.get()));
    slot.submitted = true;
}

bool Presenter::Impl::present(const Image& picture, Extent window, const Overlay& overlay) {
    if ((!swapchain || madeFor != window) && !makeSwapchain(window)) {
        dropSwapchain();
        return false;
    }
    Slot& slot = slots[presented % slots.size()];
    if (std::exchange(slot.submitted, false)) waitAndReset(*context, slot.fence.get());
    uint32_t index = 0;
    const VkResult acquired = vkAcquireNextImageKHR(context->device(), swapchain.get(), UINT64_MAX,
                                                    slot.acquired.get(), VK_NULL_HANDLE, &index);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR) {
        madeFor = {};  // made anew next time
        return false;
    }
    if (acquired != VK_SUBOPTIMAL_KHR) LIMPID_VK(acquired);
    upload(slot, overlay);
    record(slot, index, picture, overlay);
    submit(slot, index);
    ++presented;
    const VkSwapchainKHR chain = swapchain.get();
    const VkSemaphore wait = rendered[index].get();
    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &wait;
    info.swapchainCount = 1;
    info.pSwapchains = &chain;
    info.pImageIndices = &index;
    const VkResult result = vkQueuePresentKHR(context->queue(), &info);
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR)
        madeFor = {};
    else
        LIMPID_VK(result);
    return true;
}

Presenter::Presenter(Device& device, const std::function<uint64_t(void*)>& makeSurface)
    : impl_(std::make_unique<Impl>(device.impl().context, makeSurface)), device_(device) {}

Presenter::~Presenter() = default;

void Presenter::setTexture(Extent extent, std::span<const uint32_t> texels) {
    impl_->setTexture(device_.impl().transfer, extent, texels);
}

bool Presenter::present(FrameGraph& graph, ImageHandle picture, Extent window, const Overlay& overlay) {
    return impl_->present(graph.imageOnDevice(device_, picture), window, overlay);
}

}  // namespace limpid::gpu
