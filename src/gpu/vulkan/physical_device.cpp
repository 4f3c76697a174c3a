#include "gpu/vulkan/physical_device.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "base/text/format.h"
#include "gpu/vulkan/check.h"
#include "gpu/vulkan/memory/format.h"

namespace limpid::gpu {
namespace {

enum class Need { Required, Enabled, Listed };  ///< Enabled: enabled if available; Listed: only reported

struct Feature {
    const char* name;
    Need need;
    VkBool32& (*flag)(FeatureChain&);
};

const Feature features[] = {
    {"synchronization2", Need::Required, [](FeatureChain& f) -> VkBool32& { return f.v13.synchronization2; }},
    {"maintenance4", Need::Required, [](FeatureChain& f) -> VkBool32& { return f.v13.maintenance4; }},
    {"scalarBlockLayout", Need::Required,
     [](FeatureChain& f) -> VkBool32& { return f.v12.scalarBlockLayout; }},
    {"shaderStorageImageExtendedFormats", Need::Required,
     [](FeatureChain& f) -> VkBool32& { return f.core.features.shaderStorageImageExtendedFormats; }},
    {"shaderUniformBufferArrayDynamicIndexing", Need::Enabled,
     [](FeatureChain& f) -> VkBool32& { return f.core.features.shaderUniformBufferArrayDynamicIndexing; }},
    {"shaderInt16", Need::Enabled, [](FeatureChain& f) -> VkBool32& { return f.core.features.shaderInt16; }},
    {"shaderInt64", Need::Enabled, [](FeatureChain& f) -> VkBool32& { return f.core.features.shaderInt64; }},
    {"shaderFloat16", Need::Enabled, [](FeatureChain& f) -> VkBool32& { return f.v12.shaderFloat16; }},
    {"storageBuffer16BitAccess", Need::Enabled,
     [](FeatureChain& f) -> VkBool32& { return f.v11.storageBuffer16BitAccess; }},
    {"subgroupSizeControl", Need::Enabled,
     [](FeatureChain& f) -> VkBool32& { return f.v13.subgroupSizeControl; }},
    {"dynamicRendering", Need::Enabled, [](FeatureChain& f) -> VkBool32& { return f.v13.dynamicRendering; }},
    {"computeFullSubgroups", Need::Enabled,
     [](FeatureChain& f) -> VkBool32& { return f.v13.computeFullSubgroups; }},
    {"bufferDeviceAddress", Need::Listed,
     [](FeatureChain& f) -> VkBool32& { return f.v12.bufferDeviceAddress; }},
    {"descriptorIndexing", Need::Listed,
     [](FeatureChain& f) -> VkBool32& { return f.v12.descriptorIndexing; }},
    {"runtimeDescriptorArray", Need::Listed,
     [](FeatureChain& f) -> VkBool32& { return f.v12.runtimeDescriptorArray; }},
    {"shaderStorageTexelBufferArrayNonUniformIndexing", Need::Listed,
     [](FeatureChain& f) -> VkBool32& { return f.v12.shaderStorageTexelBufferArrayNonUniformIndexing; }},
};

/// Extensions reported by name. VK_KHR_cooperative_matrix is newer than Debian's headers and shader compiler.
constexpr const char* listedExtensions[] = {
    VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
    VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME,
    VK_KHR_RAY_QUERY_EXTENSION_NAME,
    VK_EXT_DESCRIPTOR_INDEXING_EXTENSION_NAME,
    "VK_KHR_cooperative_matrix",
    VK_NV_COOPERATIVE_MATRIX_EXTENSION_NAME,
    VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME,
    VK_KHR_SWAPCHAIN_EXTENSION_NAME,
};

/// Required by the `hardware` tracer; the last one only because the first requires it.
constexpr const char* rayTracingExtensions[] = {
    VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
    VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME,
    VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME,
};

struct Properties {
    VkPhysicalDeviceProperties2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    VkPhysicalDeviceMaintenance3Properties maintenance3{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceMaintenance4Properties maintenance4{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES};
};

DeviceType deviceType(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return DeviceType::Discrete;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return DeviceType::Integrated;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return DeviceType::Virtual;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return DeviceType::Cpu;
        default:
            return DeviceType::Other;
    }
}

std::string versionText(uint32_t version) {
    return formatText("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                      VK_API_VERSION_PATCH(version));
}

std::set<std::string> extensionsOf(const InstanceFunctions& vk, VkPhysicalDevice handle) {
    uint32_t count = 0;
    LIMPID_VK(vk.EnumerateDeviceExtensionProperties(handle, nullptr, &count, nullptr));
    std::vector<VkExtensionProperties> extensions(count);
    LIMPID_VK(vk.EnumerateDeviceExtensionProperties(handle, nullptr, &count, extensions.data()));
    std::set<std::string> names;
    for (const VkExtensionProperties& e : extensions) names.insert(e.extensionName);
    return names;
}

uint64_t deviceLocalBytes(const InstanceFunctions& vk, VkPhysicalDevice handle) {
    VkPhysicalDeviceMemoryProperties memory{};
    vk.GetPhysicalDeviceMemoryProperties(handle, &memory);
    uint64_t largest = 0;
    for (uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
        const VkMemoryHeap& heap = memory.memoryHeaps[i];
        if (heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) largest = std::max<uint64_t>(largest, heap.size);
    }
    return largest;
}

/// Finds the first queue family with compute and timestamps. Graphics is not needed (data-centre GPUs may
/// lack it).
bool findQueueFamily(const InstanceFunctions& vk, PhysicalDevice& device) {
    uint32_t count = 0;
    vk.GetPhysicalDeviceQueueFamilyProperties(device.handle, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vk.GetPhysicalDeviceQueueFamilyProperties(device.handle, &count, families.data());
    for (uint32_t i = 0; i < count; ++i) {
        if (!(families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) || families[i].timestampValidBits == 0) continue;
        device.queueFamily = i;
        device.timestampValidBits = families[i].timestampValidBits;
        device.drawsAndPresents = (families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0;
        return true;
    }
    return false;
}

void listLimits(PhysicalDevice& device) {
    const VkPhysicalDeviceLimits& l = device.limits;
    device.info.limits = {
        {"maxTexelBufferElements", l.maxTexelBufferElements},
        {"maxStorageBufferRange", l.maxStorageBufferRange},
        {"maxUniformBufferRange", l.maxUniformBufferRange},
        {"maxPushConstantsSize", l.maxPushConstantsSize},
        {"maxMemoryAllocationSize", device.maxAllocation},
        {"maxMemoryAllocationCount", l.maxMemoryAllocationCount},
        {"maxBufferSize", device.maxBufferSize},
        {"maxImageDimension2D", l.maxImageDimension2D},
        {"maxComputeWorkGroupInvocations", l.maxComputeWorkGroupInvocations},
        {"maxComputeSharedMemorySize", l.maxComputeSharedMemorySize},
        {"maxPerStageDescriptorStorageImages", l.maxPerStageDescriptorStorageImages},
        {"maxPerStageDescriptorStorageBuffers", l.maxPerStageDescriptorStorageBuffers},
        {"maxPerStageResources", l.maxPerStageResources},
        {"minTexelBufferOffsetAlignment", l.minTexelBufferOffsetAlignment},
        {"minUniformBufferOffsetAlignment", l.minUniformBufferOffsetAlignment},
        {"minStorageBufferOffsetAlignment", l.minStorageBufferOffsetAlignment},
        {"timestampValidBits", device.timestampValidBits},
    };
}

void checkFeatures(const InstanceFunctions& vk, PhysicalDevice& device, std::vector<std::string>& missing) {
    FeatureChain available;
    vk.GetPhysicalDeviceFeatures2(device.handle, &available.core);
    for (const Feature& feature : features) {
        const bool there = feature.flag(available);
        device.info.features.emplace_back(feature.name, there);
        if (!there && feature.need == Need::Required) missing.emplace_back(feature.name);
    }
}

void checkFormats(const InstanceFunctions& vk, VkPhysicalDevice handle, std::vector<std::string>& missing) {
    for (const Format format : allFormats()) {
        VkFormatProperties properties{};
        vk.GetPhysicalDeviceFormatProperties(handle, toVulkan(format), &properties);
        if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)) {
            missing.push_back(formatText("storage images of {}", toString(format)));
        }
        if (!(properties.bufferFeatures & VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT)) {
            missing.push_back(formatText("storage texel buffers of {}", toString(format)));
        }
    }
}

void inspectRayTracing(const InstanceFunctions& vk, PhysicalDevice& device,
                       const std::set<std::string>& extensions) {
    for (const char* name : rayTracingExtensions) {
        if (!extensions.contains(name)) return;
    }
    FeatureChain available;
    available.linkRayTracing();
    vk.GetPhysicalDeviceFeatures2(device.handle, &available.core);
    device.info.rayTracing = available.v12.bufferDeviceAddress &&
                             available.accelerationStructure.accelerationStructure &&
                             available.rayTracingPipeline.rayTracingPipeline;
    // Excludes drivers that emulate ray tracing on shader cores: NVIDIA's driver offers no ray queries on
    // data-centre GPUs, but it does on GeForce 10 and 16.
    const std::string& name = device.info.name;
    device.info.rayTracingCores = device.info.rayTracing && device.info.type != DeviceType::Cpu &&
                                  extensions.contains(VK_KHR_RAY_QUERY_EXTENSION_NAME) &&
                                  name.find("GTX") == std::string::npos;
    VkPhysicalDeviceProperties2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    VkPhysicalDeviceAccelerationStructurePropertiesKHR structure{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR pipeline{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR};
    core.pNext = &structure;
    structure.pNext = &pipeline;
    vk.GetPhysicalDeviceProperties2(device.handle, &core);
    device.rayTracing = {.handleSize = pipeline.shaderGroupHandleSize,
                         .handleAlignment = pipeline.shaderGroupHandleAlignment,
                         .baseAlignment = pipeline.shaderGroupBaseAlignment,
                         .scratchAlignment = structure.minAccelerationStructureScratchOffsetAlignment,
                         .maxInvocations = pipeline.maxRayDispatchInvocationCount,
                         .maxInstances = structure.maxInstanceCount,
                         .maxPrimitives = structure.maxPrimitiveCount};
}

/// What shaders with cooperative matrices may use.
constexpr uint32_t matrixSharedBytes = 48 << 10;

void inspectCooperativeMatrices(const InstanceFunctions& vk, PhysicalDevice& device,
                                const std::set<std::string>& extensions) {
    if (!extensions.contains(VK_NV_COOPERATIVE_MATRIX_EXTENSION_NAME)) return;
    FeatureChain available;
    available.linkCooperativeMatrix();
    vk.GetPhysicalDeviceFeatures2(device.handle, &available.core);
    VkPhysicalDeviceProperties2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    VkPhysicalDeviceSubgroupProperties subgroup{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    core.pNext = &subgroup;
    vk.GetPhysicalDeviceProperties2(device.handle, &core);
    // Shaders with cooperative matrices declare the Vulkan memory model. Where it is enabled, the atomics of
    // other shaders need device scope.
    if (!available.cooperativeMatrix.cooperativeMatrix || !available.v12.shaderFloat16 ||
        !available.v12.vulkanMemoryModel || !available.v12.vulkanMemoryModelDeviceScope ||
        subgroup.subgroupSize != 32 || core.properties.limits.maxComputeSharedMemorySize < matrixSharedBytes)
        return;
    uint32_t count = 0;
    LIMPID_VK(vk.GetPhysicalDeviceCooperativeMatrixPropertiesNV(device.handle, &count, nullptr));
    std::vector<VkCooperativeMatrixPropertiesNV> kinds(count,
                                                       {VK_STRUCTURE_TYPE_COOPERATIVE_MATRIX_PROPERTIES_NV});
    LIMPID_VK(vk.GetPhysicalDeviceCooperativeMatrixPropertiesNV(device.handle, &count, kinds.data()));
    device.info.cooperativeMatrices =
        std::ranges::any_of(kinds, [](const VkCooperativeMatrixPropertiesNV& kind) {
            return kind.MSize == 16 && kind.NSize == 16 && kind.KSize == 16 &&
                   kind.scope == VK_SCOPE_SUBGROUP_NV && kind.AType == VK_COMPONENT_TYPE_FLOAT16_NV &&
                   kind.BType == VK_COMPONENT_TYPE_FLOAT16_NV && kind.CType == VK_COMPONENT_TYPE_FLOAT32_NV &&
                   kind.DType == VK_COMPONENT_TYPE_FLOAT32_NV;
        });
}

/// Queries the properties that a driver of this version knows.
void readProperties(const InstanceFunctions& vk, PhysicalDevice& device, uint32_t version) {
    Properties properties;
    properties.core.pNext = &properties.maintenance3;
    if (version >= VK_API_VERSION_1_2) properties.maintenance3.pNext = &properties.driver;
    if (version >= VK_API_VERSION_1_3) properties.driver.pNext = &properties.maintenance4;
    vk.GetPhysicalDeviceProperties2(device.handle, &properties.core);
    device.limits = properties.core.properties.limits;
    device.maxAllocation = properties.maintenance3.maxMemoryAllocationSize;
    device.maxBufferSize = properties.maintenance4.maxBufferSize;
    if (version >= VK_API_VERSION_1_2) {
        device.info.driver = formatText("{} {}", properties.driver.driverName, properties.driver.driverInfo);
    }
}

}  // namespace

void FeatureChain::linkRayTracing() {
    v13.pNext = &accelerationStructure;
    accelerationStructure.pNext = &rayTracingPipeline;
}

void FeatureChain::linkCooperativeMatrix() {
    cooperativeMatrix.pNext = core.pNext;
    core.pNext = &cooperativeMatrix;
}

FeatureChain::FeatureChain() {
    core.pNext = &v11;
    v11.pNext = &v12;
    v12.pNext = &v13;
}

PhysicalDevice inspect(const InstanceFunctions& vk, VkPhysicalDevice handle, uint32_t index) {
    PhysicalDevice device;
    device.handle = handle;
    VkPhysicalDeviceProperties basics{};
    vk.GetPhysicalDeviceProperties(handle, &basics);
    DeviceInfo& info = device.info;
    info.index = index;
    info.name = basics.deviceName;
    info.type = deviceType(basics.deviceType);
    info.apiVersion = versionText(basics.apiVersion);
    info.memoryBytes = deviceLocalBytes(vk, handle);
    device.limits = basics.limits;

    std::vector<std::string> missing;
    if (!findQueueFamily(vk, device)) missing.emplace_back("a queue that computes and has timestamps");
    if (basics.apiVersion >= VK_API_VERSION_1_1) readProperties(vk, device, basics.apiVersion);
    if (basics.apiVersion < VK_API_VERSION_1_3) {
        missing.push_back(formatText("Vulkan 1.3 (it has {})", info.apiVersion));
    } else {
        checkFeatures(vk, device, missing);
        checkFormats(vk, handle, missing);
    }
    const std::set<std::string> extensions = extensionsOf(vk, handle);
    device.drawsAndPresents = device.drawsAndPresents && extensions.contains(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    for (const char* name : listedExtensions) info.features.emplace_back(name, extensions.contains(name));
    if (basics.apiVersion >= VK_API_VERSION_1_3) {
        inspectRayTracing(vk, device, extensions);
        inspectCooperativeMatrices(vk, device, extensions);
    }
    listLimits(device);
    info.usable = missing.empty();
    info.whyNot = joinText(missing);
    return device;
}

std::vector<PhysicalDevice> inspectAll(const Instance& instance) {
    std::vector<PhysicalDevice> devices;
    for (VkPhysicalDevice handle : instance.physicalDevices()) {
        devices.push_back(inspect(instance.vk(), handle, static_cast<uint32_t>(devices.size())));
        devices.back().info.features.emplace_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                                                  instance.hasDebugUtils());
    }
    return devices;
}

void enableFeatures(const InstanceFunctions& vk, const PhysicalDevice& device, FeatureChain& wanted) {
    FeatureChain available;
    vk.GetPhysicalDeviceFeatures2(device.handle, &available.core);
    for (const Feature& feature : features) {
        if (feature.need != Need::Listed) feature.flag(wanted) = feature.flag(available);
    }
    if (device.info.cooperativeMatrices) {
        wanted.linkCooperativeMatrix();
        wanted.cooperativeMatrix.cooperativeMatrix = VK_TRUE;
        wanted.v12.vulkanMemoryModel = wanted.v12.vulkanMemoryModelDeviceScope = VK_TRUE;
    }
    if (!device.info.rayTracing) return;
    wanted.linkRayTracing();
    wanted.v12.bufferDeviceAddress = VK_TRUE;
    wanted.accelerationStructure.accelerationStructure = VK_TRUE;
    wanted.rayTracingPipeline.rayTracingPipeline = VK_TRUE;
}

std::vector<const char*> wantedExtensions(const PhysicalDevice& device) {
    std::vector<const char*> names;
    if (device.info.cooperativeMatrices) names.push_back(VK_NV_COOPERATIVE_MATRIX_EXTENSION_NAME);
    if (device.info.rayTracing)
        names.insert(names.end(), std::begin(rayTracingExtensions), std::end(rayTracingExtensions));
    return names;
}

}  // namespace limpid::gpu
