// Limpid's denoisers inside a Vulkan program, for C++17: denoise_vulkan.h with the classes of denoise.hpp.
//
//     limpid::enableFeatures(features);                        // before vkCreateDevice
//     limpid::Device device = limpid::adopt(instance, physicalDevice, own, family, vkGetInstanceProcAddr);
//     limpid::Denoiser denoiser(device, limpid::DenoiserDesc(1280, 720));
//     limpid::VulkanFrame frame;
//     frame.inputs[LIMPID_INPUT_RADIANCE] = ...;
//     limpid::record(denoiser, commands, frame);
//
// Barriers, layouts and lifetimes are as denoise_vulkan.h says.
#ifndef LIMPID_DENOISE_VULKAN_HPP
#define LIMPID_DENOISE_VULKAN_HPP

#include <limpid/denoise_vulkan.h>

#include <limpid/denoise.hpp>

namespace limpid {
inline namespace v0 {

using VulkanDeviceDesc = Sized<limpid_vulkan_device_desc>;
using VulkanFrame = Sized<limpid_vulkan_frame>;

/// An image, in which layout it is, and what used it last: all that an input needs. An output that is read
/// after the frame sets `layout_after` and so on besides.
inline limpid_vulkan_image image(VkImage handle, VkImageView view, VkFormat format, VkImageLayout layout,
                                 VkPipelineStageFlags2 stagesBefore, VkAccessFlags2 accessBefore) {
    limpid_vulkan_image result{};
    result.image = handle;
    result.view = view;
    result.format = format;
    result.layout = layout;
    result.stages_before = stagesBefore;
    result.access_before = accessBefore;
    return result;
}

/// Switches on what Limpid needs in the chain that begins with `features`.
inline void enableFeatures(VkPhysicalDeviceFeatures2& features) {
    check(limpid_vulkan_enable_features(&features));
}

/// A device of the caller's, whose Vulkan objects outlive what is returned.
inline Device adopt(const limpid_vulkan_device_desc& desc) {
    limpid_device* made = nullptr;
    check(limpid_device_adopt(&desc, &made));
    return Device(made);
}

/// The same, from what every program has.
inline Device adopt(VkInstance instance, VkPhysicalDevice physicalDevice, VkDevice device,
                    uint32_t queueFamily, PFN_vkGetInstanceProcAddr getInstanceProcAddr) {
    VulkanDeviceDesc desc;
    desc.instance = instance;
    desc.physical_device = physicalDevice;
    desc.device = device;
    desc.queue_family = queueFamily;
    desc.get_instance_proc_addr = getInstanceProcAddr;
    return adopt(desc);
}

/// Records one frame into a command buffer.
inline void record(Denoiser& denoiser, VkCommandBuffer commands, const limpid_vulkan_frame& frame) {
    check(limpid_record(denoiser.get(), commands, &frame));
}

/// Records all passes over a few pixels, for drivers that compile at the first dispatch.
inline void warmUp(Denoiser& denoiser, VkCommandBuffer commands, const limpid_vulkan_frame& frame) {
    check(limpid_warm_up(denoiser.get(), commands, &frame));
}

}  // namespace v0
}  // namespace limpid
#endif
