// Lists physical devices and their features, checks Limpid's requirements, and selects the device a user asks
// for.
#pragma once

#include <string>
#include <vector>

#include "gpu/vulkan/device.h"
#include "gpu/vulkan/instance.h"

namespace limpid::gpu {

/// The feature structures of Vulkan 1.3, chained for a query or for device creation. Not copyable: they point
/// to each other.
struct FeatureChain {
    FeatureChain();
    FeatureChain(const FeatureChain&) = delete;
    FeatureChain& operator=(const FeatureChain&) = delete;

    VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    /// Chained by linkRayTracing(), only if the driver knows their extensions.
    VkPhysicalDeviceAccelerationStructureFeaturesKHR accelerationStructure{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR rayTracingPipeline{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR};
    void linkRayTracing();
    VkPhysicalDeviceCooperativeMatrixFeaturesNV cooperativeMatrix{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_COOPERATIVE_MATRIX_FEATURES_NV};
    void linkCooperativeMatrix();
};

/// Device properties needed by ray-tracing pipelines.
struct RayTracingLimits {
    uint32_t handleSize = 0, handleAlignment = 0, baseAlignment = 0;  ///< for shader-binding tables
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
    uint32_t queueFamily = 0;  ///< supports compute and timestamps
    uint32_t timestampValidBits = 0;
    RayTracingLimits rayTracing;    ///< valid if info.rayTracing
    bool drawsAndPresents = false;  ///< the queue supports graphics, and swapchains are available
};

/// Queries all properties; info.whyNot lists what is missing.
PhysicalDevice inspect(const InstanceFunctions& vk, VkPhysicalDevice handle, uint32_t index);
std::vector<PhysicalDevice> inspectAll(const Instance& instance);

/// Selects the device for DeviceOptions::select. Throws Error that explains why none matches and lists the
/// available ones.
PhysicalDevice choose(std::vector<PhysicalDevice> devices, const std::string& select);
/// Returns the index that choose() selects, given only the devices' infos.
size_t chooseIndex(const std::vector<DeviceInfo>& infos, const std::string& select);

/// Enables the required features in `wanted`, and optional ones if the device has them.
void enableFeatures(const InstanceFunctions& vk, const PhysicalDevice& device, FeatureChain& wanted);
/// Returns the device extensions to enable.
std::vector<const char*> wantedExtensions(const PhysicalDevice& device);

}  // namespace limpid::gpu
