// What a physical device offers, what Limpid needs of it, and which one a user means.
#pragma once

#include <string>
#include <vector>

#include "gpu/vulkan/device.h"
#include "gpu/vulkan/instance.h"

namespace limpid::gpu {

/// The feature structures of Vulkan 1.3, linked for a query or for device creation. Not copyable: they point
/// at each other.
struct FeatureChain {
    FeatureChain();
    FeatureChain(const FeatureChain&) = delete;
    FeatureChain& operator=(const FeatureChain&) = delete;

    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    /// Linked by linkRayTracing(): only where the driver knows their extensions.
    VkPhysicalDeviceAccelerationStructureFeaturesKHR accelerationStructure{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR rayTracingPipeline{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR};
    void linkRayTracing();
    VkPhysicalDeviceCooperativeMatrixFeaturesNV cooperativeMatrix{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_COOPERATIVE_MATRIX_FEATURES_NV};
    void linkCooperativeMatrix();
};

/// What ray-tracing pipelines need to know of the device.
struct RayTracingLimits {
    uint32_t handleSize = 0, handleAlignment = 0, baseAlignment = 0;  ///< of shader-binding tables
    uint32_t scratchAlignment = 0;
    uint32_t maxInvocations = 0;
    uint64_t maxInstances = 0, maxPrimitives = 0;
};

struct PhysicalDevice {
    VkPhysicalDevice handle = VK_NULL_HANDLE;
    DeviceInfo info;
    VkPhysicalDeviceLimits limits{};
    uint64_t maxAllocation = 0;
    uint64_t maxBufferSize = 0;
    uint32_t queueFamily = 0;  ///< computes, and has timestamps
    uint32_t timestampValidBits = 0;
    RayTracingLimits rayTracing;    ///< if info.rayTracing
    bool drawsAndPresents = false;  ///< the queue draws triangles, and there are swapchains
};

/// Reads everything; info.whyNot says what is missing.
PhysicalDevice inspect(const InstanceFunctions& vk, VkPhysicalDevice handle, uint32_t index);
std::vector<PhysicalDevice> inspectAll(const Instance& instance);

/// The device that DeviceOptions::select means. Throws Error saying why there is none and listing what there
/// is.
PhysicalDevice choose(std::vector<PhysicalDevice> devices, const std::string& select);
/// The index that choose() takes, of devices described only by their infos.
size_t chooseIndex(const std::vector<DeviceInfo>& infos, const std::string& select);

/// Switches on in `wanted` what Limpid requires, and what it can use if the device has it.
void enableFeatures(const InstanceFunctions& vk, const PhysicalDevice& device, FeatureChain& wanted);
/// The extensions to switch on.
std::vector<const char*> wantedExtensions(const PhysicalDevice& device);

}  // namespace limpid::gpu
