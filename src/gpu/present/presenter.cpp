#include "gpu/present/presenter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "base/error.h"
#include "gpu/graph/frame_graph_impl.h"
#include "gpu/present/overlay_drawer.h"
#include "gpu/present/surface_encoder.h"
#include "gpu/present/surface_format.h"
#include "gpu/vulkan/check.h"
#include "gpu/vulkan/device_impl.h"
#include "gpu/vulkan/execute/frame_executor.h"

namespace limpid::gpu {
namespace {

/// The resources of one picture in flight.
struct Slot {
    UniqueCommandPool pool;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    UniqueFence fence;
    UniqueSemaphore acquired;
    OverlayDrawer::Triangles triangles;
    bool submitted = false;
};

UniqueSemaphore makeSemaphore(const Context& context) {
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    LIMPID_VK(context.vk().CreateSemaphore(context.device(), &info, nullptr, &semaphore));
    return {context.vk(), semaphore};
}

void imageBarrier(const Context& context, VkCommandBuffer commands, VkImage image, VkImageLayout from,
                  VkImageLayout to, VkPipelineStageFlags2 fromStage, VkAccessFlags2 fromAccess,
                  VkPipelineStageFlags2 toStage, VkAccessFlags2 toAccess) {
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
    context.vk().CmdPipelineBarrier2(commands, &dependency);
}

/// A pane and its picture.
struct DevicePane {
    const Image* picture;
    Rectangle source, target;
    bool enlarge;
};

/// Returns the corners of a part of an image, in pixels; at least one pixel large.
std::array<VkOffset3D, 2> corners(const Rectangle& share, Extent whole) {
    const auto pixel = [](float at, uint32_t pixels) {
        return static_cast<int32_t>(std::lround(std::clamp(at, 0.0f, 1.0f) * static_cast<float>(pixels)));
    };
    const auto width = static_cast<int32_t>(whole.width), height = static_cast<int32_t>(whole.height);
    const int32_t left = std::min(pixel(share.left, whole.width), width - 1),
                  top = std::min(pixel(share.top, whole.height), height - 1);
    return {{{left, top, 0},
             {std::max(pixel(share.right, whole.width), left + 1),
              std::max(pixel(share.bottom, whole.height), top + 1), 1}}};
}

}  // namespace

struct Presenter::Impl {
    Impl(std::shared_ptr<const Context> from, const std::function<uint64_t(void*)>& makeSurface);
    ~Impl();

    bool present(std::span<const DevicePane> panes, Extent window, const Overlay& overlay);

    void readOffered();
    void chooseFormat();
    bool makeSwapchain(Extent window);
    void dropSwapchain();
    void record(const Slot& slot, uint32_t index, std::span<const DevicePane> panes,
                const Overlay& overlay) const;
    void recordDirectly(const Slot& slot, uint32_t index, std::span<const DevicePane> panes,
                        const Overlay& overlay) const;
    void recordEncoded(const Slot& slot, uint32_t index, std::span<const DevicePane> panes,
                       const Overlay& overlay) const;
    void blit(VkCommandBuffer commands, VkImage target, VkImageLayout layout,
              std::span<const DevicePane> panes) const;
    void submit(Slot& slot, uint32_t index) const;

    std::shared_ptr<const Context> context;
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    std::vector<VkSurfaceFormatKHR> offered;
    std::optional<HighRange> wanted;
    std::optional<SurfaceFormat> format;
    OverlayDrawer overlays;
    std::optional<SurfaceEncoder> encoder;  ///< none: the range is that of sRGB

    UniqueSwapchain swapchain;
    Extent extent;                  ///< swapchain's extent
    std::optional<Extent> madeFor;  ///< the window's extent; none: it must be made anew
    std::vector<VkImage> images;
    std::vector<UniqueImageView> views;
    std::vector<UniqueSemaphore> rendered;  ///< one per image
    std::array<Slot, 2> slots;
    uint64_t presented = 0;
};

Presenter::Impl::Impl(std::shared_ptr<const Context> from, const std::function<uint64_t(void*)>& makeSurface)
    : context(std::move(from)), overlays(context) {
    if (!context->presents())
        throw Error(context->info().name + " cannot show pictures in windows; 'limpid render' writes files");
    surface = reinterpret_cast<VkSurfaceKHR>(makeSurface(context->instance()));
    VkBool32 supported = VK_FALSE;
    LIMPID_VK(context->instanceVk().GetPhysicalDeviceSurfaceSupportKHR(
        context->physicalDevice(), context->queueFamily(), surface, &supported));
    if (!supported)
        throw Error(context->info().name +
                    " cannot show pictures in this window; 'limpid render' writes files");
    readOffered();
    chooseFormat();
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
    if (surface != VK_NULL_HANDLE)
        context->instanceVk().DestroySurfaceKHR(context->instance(), surface, nullptr);
}

void Presenter::Impl::readOffered() {
    uint32_t count = 0;
    LIMPID_VK(context->instanceVk().GetPhysicalDeviceSurfaceFormatsKHR(context->physicalDevice(), surface,
                                                                       &count, nullptr));
    offered.resize(count);
    LIMPID_VK(context->instanceVk().GetPhysicalDeviceSurfaceFormatsKHR(context->physicalDevice(), surface,
                                                                       &count, offered.data()));
}

/// Chooses the format for the next swapchain, and what draws into it. The device must be idle.
void Presenter::Impl::chooseFormat() {
    std::optional<SurfaceFormat> next = wanted ? highRangeFormat(offered) : std::nullopt;
    if (!next) next = standardFormat(offered);
    if (!next) throw Error("this window takes no 8-bit sRGB pictures from " + context->info().name);
    if (format && format->vulkan.format == next->vulkan.format && format->encoding == next->encoding) return;
    format = next;
    encoder.reset();
    if (format->encoding != SurfaceEncoding::Srgb) encoder.emplace(context, *format);
    overlays.setTarget(encoder ? SurfaceEncoder::composedFormat : format->vulkan.format);
}

void Presenter::Impl::dropSwapchain() {
    rendered.clear();
    views.clear();
    images.clear();
    swapchain = {};
}

/// Returns false if the window has no pixels.
bool Presenter::Impl::makeSwapchain(Extent window) {
    context->waitIdle();
    readOffered();
    chooseFormat();
    VkSurfaceCapabilitiesKHR can{};
    LIMPID_VK(context->instanceVk().GetPhysicalDeviceSurfaceCapabilitiesKHR(context->physicalDevice(),
                                                                            surface, &can));
    const bool free = can.currentExtent.width == UINT32_MAX;  // the swapchain decides its own size
    const Extent size = free ? window : Extent{can.currentExtent.width, can.currentExtent.height};
    extent = {std::clamp(size.width, can.minImageExtent.width, can.maxImageExtent.width),
              std::clamp(size.height, can.minImageExtent.height, can.maxImageExtent.height)};
    madeFor = window;
    if (size.width == 0 || size.height == 0 || extent.width == 0 || extent.height == 0) return false;
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface;
    info.minImageCount = std::max(3u, can.minImageCount);
    if (can.maxImageCount != 0) info.minImageCount = std::min(info.minImageCount, can.maxImageCount);
    info.imageFormat = format->vulkan.format;
    info.imageColorSpace = format->vulkan.colorSpace;
    info.imageExtent = {extent.width, extent.height};
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain.get();
    VkSwapchainKHR raw = VK_NULL_HANDLE;
    LIMPID_VK(context->vk().CreateSwapchainKHR(context->device(), &info, nullptr, &raw));
    dropSwapchain();
    swapchain = UniqueSwapchain(context->vk(), raw);
    uint32_t count = 0;
    LIMPID_VK(context->vk().GetSwapchainImagesKHR(context->device(), raw, &count, nullptr));
    images.resize(count);
    LIMPID_VK(context->vk().GetSwapchainImagesKHR(context->device(), raw, &count, images.data()));
    for (const VkImage image : images) {
        VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
        view.image = image;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = format->vulkan.format;
        view.subresourceRange = wholeImage();
        VkImageView made = VK_NULL_HANDLE;
        LIMPID_VK(context->vk().CreateImageView(context->device(), &view, nullptr, &made));
        views.emplace_back(context->vk(), made);
        rendered.push_back(makeSemaphore(*context));
    }
    if (encoder) encoder->resize(extent);
    return true;
}

void Presenter::Impl::blit(VkCommandBuffer commands, VkImage target, VkImageLayout layout,
                           std::span<const DevicePane> panes) const {
    for (const DevicePane& pane : panes) {
        const auto source = corners(pane.source, pane.picture->extent), place = corners(pane.target, extent);
        const int32_t from = source[1].x - source[0].x, to = place[1].x - place[0].x;
        VkImageBlit region{};
        region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        std::copy(source.begin(), source.end(), region.srcOffsets);
        std::copy(place.begin(), place.end(), region.dstOffsets);
        const bool pixels = from == to || pane.enlarge;
        context->vk().CmdBlitImage(commands, pane.picture->image.get(), VK_IMAGE_LAYOUT_GENERAL, target,
                                   layout, 1, &region, pixels ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
        // The next pane may overlap it.
        memoryBarrier(*context, commands, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    }
}

void Presenter::Impl::record(const Slot& slot, uint32_t index, std::span<const DevicePane> panes,
                             const Overlay& overlay) const {
    const VkCommandBuffer commands = slot.commands;
    LIMPID_VK(context->vk().ResetCommandPool(context->device(), slot.pool.get(), 0));
    beginCommands(*context, commands);
    // The frame that rendered the picture was submitted to the same queue.
    memoryBarrier(*context, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
    if (encoder)
        recordEncoded(slot, index, panes, overlay);
    else
        recordDirectly(slot, index, panes, overlay);
    imageBarrier(*context, commands, images[index], VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                 VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT, VK_PIPELINE_STAGE_2_NONE, 0);
    LIMPID_VK(context->vk().EndCommandBuffer(commands));
}

/// Composes in the swapchain's image.
void Presenter::Impl::recordDirectly(const Slot& slot, uint32_t index, std::span<const DevicePane> panes,
                                     const Overlay& overlay) const {
    const VkCommandBuffer commands = slot.commands;
    imageBarrier(*context, commands, images[index], VK_IMAGE_LAYOUT_UNDEFINED,
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_BLIT_BIT, 0,
                 VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    blit(commands, images[index], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, panes);
    imageBarrier(*context, commands, images[index], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_BLIT_BIT,
                 VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                 VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
    overlays.draw(commands, slot.triangles, overlay, views[index].get(),
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, extent);
}

/// Composes as sRGB in the encoder's image, so that transparent parts of the overlay look as usual, and
/// converts that.
void Presenter::Impl::recordEncoded(const Slot& slot, uint32_t index, std::span<const DevicePane> panes,
                                    const Overlay& overlay) const {
    const VkCommandBuffer commands = slot.commands;
    const Image& composed = encoder->composed();
    imageBarrier(*context, commands, composed.image.get(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL,
                 VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, 0, VK_PIPELINE_STAGE_2_BLIT_BIT,
                 VK_ACCESS_2_TRANSFER_WRITE_BIT);
    blit(commands, composed.image.get(), VK_IMAGE_LAYOUT_GENERAL, panes);
    memoryBarrier(*context, commands, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                  VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
    overlays.draw(commands, slot.triangles, overlay, composed.view.get(), VK_IMAGE_LAYOUT_GENERAL, extent);
    memoryBarrier(*context, commands,
                  VK_PIPELINE_STAGE_2_BLIT_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                  VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
    imageBarrier(*context, commands, images[index], VK_IMAGE_LAYOUT_UNDEFINED,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, 0,
                 VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                 VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
    encoder->encode(commands, views[index].get(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, *wanted);
}

void Presenter::Impl::submit(Slot& slot, uint32_t index) const {
    VkSemaphoreSubmitInfo wait{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO},
        signal{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    wait.semaphore = slot.acquired.get();
    wait.stageMask = VK_PIPELINE_STAGE_2_BLIT_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    signal.semaphore = rendered[index].get();
    signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = slot.commands;
    VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    info.waitSemaphoreInfoCount = info.signalSemaphoreInfoCount = info.commandBufferInfoCount = 1;
    info.pWaitSemaphoreInfos = &wait;
    info.pSignalSemaphoreInfos = &signal;
    info.pCommandBufferInfos = &commands;
    LIMPID_VK(context->vk().QueueSubmit2(context->queue(), 1, &info, slot.fence.get()));
    slot.submitted = true;
}

bool Presenter::Impl::present(std::span<const DevicePane> panes, Extent window, const Overlay& overlay) {
    if ((!swapchain || madeFor != window) && !makeSwapchain(window)) {
        dropSwapchain();
        return false;
    }
    Slot& slot = slots[presented % slots.size()];
    if (std::exchange(slot.submitted, false)) waitAndReset(*context, slot.fence.get());
    uint32_t index = 0;
    const VkResult acquired = context->vk().AcquireNextImageKHR(
        context->device(), swapchain.get(), UINT64_MAX, slot.acquired.get(), VK_NULL_HANDLE, &index);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR) {
        madeFor.reset();  // recreated next time
        return false;
    }
    if (acquired != VK_SUBOPTIMAL_KHR) LIMPID_VK(acquired);
    overlays.upload(slot.triangles, overlay);
    record(slot, index, panes, overlay);
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
    const VkResult result = context->vk().QueuePresentKHR(context->queue(), &info);
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR)
        madeFor.reset();
    else
        LIMPID_VK(result);
    return true;
}

Presenter::Presenter(Device& device, const std::function<uint64_t(void*)>& makeSurface)
    : impl_(std::make_unique<Impl>(device.impl().context, makeSurface)), device_(device) {}

Presenter::~Presenter() = default;

void Presenter::setTexture(Extent extent, std::span<const uint32_t> texels) {
    impl_->overlays.setTexture(device_.impl().transfer(), extent, texels);
}

std::string Presenter::highRangeFault() const {
    const Context& context = *impl_->context;
    if (highRangeFormat(impl_->offered)) return {};
    if (!context.hasColorSpaces())
        return "the Vulkan driver has no colour spaces for HDR (VK_EXT_swapchain_colorspace)";
    return context.info().name + " offers no HDR format for this window (16-bit scRGB or HDR10)";
}

void Presenter::setHighRange(const std::optional<HighRange>& wanted) {
    if (wanted.has_value() != impl_->wanted.has_value()) impl_->madeFor.reset();  // another swapchain
    impl_->wanted = wanted;
}

bool Presenter::present(std::span<const Pane> panes, Extent window, const Overlay& overlay) {
    std::vector<DevicePane> shown;
    for (const Pane& pane : panes)
        shown.push_back(
            {&pane.graph->imageOnDevice(device_, pane.picture), pane.source, pane.target, pane.enlarge});
    return impl_->present(shown, window, overlay);
}

}  // namespace limpid::gpu
