// The Vulkan functions that Limpid calls, loaded for each instance and each device. There is no global table:
// the caller's device and our own can exist side by side, and the library exports no Vulkan symbol.
#pragma once

#include "gpu/vulkan/vk.h"

namespace limpid::gpu {

// clang-format off
#define LIMPID_LOADER_FUNCTIONS(X) \
    X(CreateInstance) X(EnumerateInstanceExtensionProperties) X(EnumerateInstanceLayerProperties) \
    X(EnumerateInstanceVersion)

#define LIMPID_INSTANCE_FUNCTIONS(X) \
    X(CreateDebugUtilsMessengerEXT) X(CreateDevice) X(DestroyDebugUtilsMessengerEXT) X(DestroyInstance) \
    X(DestroySurfaceKHR) X(EnumerateDeviceExtensionProperties) X(EnumeratePhysicalDevices) \
    X(GetPhysicalDeviceCooperativeMatrixPropertiesNV) X(GetPhysicalDeviceFeatures2) \
    X(GetPhysicalDeviceFormatProperties) X(GetPhysicalDeviceMemoryProperties) \
    X(GetPhysicalDeviceProperties) X(GetPhysicalDeviceProperties2) \
    X(GetPhysicalDeviceQueueFamilyProperties) X(GetPhysicalDeviceSurfaceCapabilitiesKHR) \
    X(GetPhysicalDeviceSurfaceFormatsKHR) X(GetPhysicalDeviceSurfaceSupportKHR) X(GetDeviceProcAddr)

#define LIMPID_DEVICE_FUNCTIONS(X) \
    X(AcquireNextImageKHR) X(AllocateCommandBuffers) X(AllocateDescriptorSets) X(AllocateMemory) \
    X(BeginCommandBuffer) X(BindBufferMemory) X(BindImageMemory) X(CmdBeginDebugUtilsLabelEXT) \
    X(CmdBeginRendering) X(CmdBindDescriptorSets) X(CmdBindIndexBuffer) X(CmdBindPipeline) \
    X(CmdBindVertexBuffers) X(CmdBlitImage) X(CmdBuildAccelerationStructuresKHR) X(CmdClearColorImage) \
    X(CmdCopyAccelerationStructureKHR) X(CmdCopyBuffer) X(CmdCopyBufferToImage) X(CmdCopyImageToBuffer) \
    X(CmdDispatch) X(CmdDispatchBase) X(CmdDraw) X(CmdDrawIndexed) X(CmdEndDebugUtilsLabelEXT) \
    X(CmdEndRendering) X(CmdFillBuffer) \
    X(CmdPipelineBarrier2) X(CmdPushConstants) X(CmdResetQueryPool) X(CmdSetScissor) X(CmdSetViewport) \
    X(CmdTraceRaysKHR) X(CmdWriteAccelerationStructuresPropertiesKHR) X(CmdWriteTimestamp2) \
    X(CreateAccelerationStructureKHR) X(CreateBuffer) X(CreateBufferView) X(CreateCommandPool) \
    X(CreateComputePipelines) X(CreateDescriptorPool) X(CreateDescriptorSetLayout) X(CreateFence) \
    X(CreateGraphicsPipelines) X(CreateImage) X(CreateImageView) X(CreatePipelineCache) \
    X(CreatePipelineLayout) X(CreateQueryPool) X(CreateRayTracingPipelinesKHR) X(CreateSemaphore) \
    X(CreateShaderModule) X(CreateSwapchainKHR) X(DestroyAccelerationStructureKHR) X(DestroyBuffer) \
    X(DestroyBufferView) X(DestroyCommandPool) X(DestroyDescriptorPool) X(DestroyDescriptorSetLayout) \
    X(DestroyDevice) X(DestroyFence) X(DestroyImage) X(DestroyImageView) X(DestroyPipeline) \
    X(DestroyPipelineCache) X(DestroyPipelineLayout) X(DestroyQueryPool) X(DestroySemaphore) \
    X(DestroyShaderModule) X(DestroySwapchainKHR) X(DeviceWaitIdle) X(EndCommandBuffer) X(FreeMemory) \
    X(GetAccelerationStructureBuildSizesKHR) X(GetAccelerationStructureDeviceAddressKHR) \
    X(GetBufferDeviceAddress) X(GetBufferMemoryRequirements) X(GetDeviceQueue) \
    X(GetImageMemoryRequirements) X(GetPipelineCacheData) X(GetQueryPoolResults) \
    X(GetRayTracingShaderGroupHandlesKHR) X(GetSwapchainImagesKHR) X(MapMemory) X(QueuePresentKHR) \
    X(QueueSubmit2) X(ResetCommandPool) X(ResetDescriptorPool) X(ResetFences) \
    X(SetDebugUtilsObjectNameEXT) X(UpdateDescriptorSets) X(WaitForFences)

// clang-format on

#define LIMPID_FUNCTION(name) PFN_vk##name name = nullptr;

/// Functions that need no instance. Missing functions are null: a Vulkan 1.0 loader has no
/// EnumerateInstanceVersion.
struct LoaderFunctions {
    PFN_vkGetInstanceProcAddr GetInstanceProcAddr = nullptr;
    LIMPID_LOADER_FUNCTIONS(LIMPID_FUNCTION)

    explicit LoaderFunctions(PFN_vkGetInstanceProcAddr getInstanceProcAddr);
};

/// Functions of missing instance extensions are null.
struct InstanceFunctions {
    LIMPID_INSTANCE_FUNCTIONS(LIMPID_FUNCTION)

    InstanceFunctions() = default;
    InstanceFunctions(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance);
};

/// Functions of missing device extensions are null.
struct DeviceFunctions {
    VkDevice device = VK_NULL_HANDLE;
    LIMPID_DEVICE_FUNCTIONS(LIMPID_FUNCTION)

    DeviceFunctions() = default;
    DeviceFunctions(const InstanceFunctions& instance, VkDevice device);
};

#undef LIMPID_FUNCTION

/// Returns the entry point of the system's Vulkan loader, which stays loaded until the process ends. Null if
/// there is none.
PFN_vkGetInstanceProcAddr systemLoader();

}  // namespace limpid::gpu
