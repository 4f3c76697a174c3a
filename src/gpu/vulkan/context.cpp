#include "gpu/vulkan/context.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "base/error.h"
#include "base/text/format.h"
#include "gpu/vulkan/check.h"

namespace limpid::gpu {
namespace {

bool validationWanted(const DeviceOptions& options) {
    if (!options.readsEnvironment) return options.validation;
    const char* variable = std::getenv("LIMPID_VALIDATION");
    return options.validation || (variable && std::string_view(variable) == "1");
}

/// Throws UsageError if there is no such queue family, or it does not compute.
uint32_t timestampBits(const InstanceFunctions& vk, VkPhysicalDevice device, uint32_t family) {
    uint32_t count = 0;
    vk.GetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vk.GetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    if (family >= count) throw UsageError(formatText("the device has no queue family {}", family));
    if (!(families[family].queueFlags & VK_QUEUE_COMPUTE_BIT))
        throw UsageError(formatText("queue family {} of the device does not compute", family));
    return families[family].timestampValidBits;
}

/// Functions of Vulkan 1.1 to 1.3 may be missing on a new device if the program asked for an older version.
template <typename Function>
void require(Function function, const char* name) {
    if (!function)
        throw Unsupported(
            formatText("the program's Vulkan has no {}: the instance must be created with "
                       "VkApplicationInfo::apiVersion 1.3 or later",
                       name));
}

InstanceFunctions adoptedFunctions(const AdoptedDevice& adopted) {
    const InstanceFunctions vk(adopted.getInstanceProcAddr, adopted.instance);
    require(vk.GetDeviceProcAddr, "vkGetDeviceProcAddr");
    require(vk.GetPhysicalDeviceFeatures2, "vkGetPhysicalDeviceFeatures2");
    require(vk.GetPhysicalDeviceProperties2, "vkGetPhysicalDeviceProperties2");
    return vk;
}

}  // namespace

Context::Context(const DeviceOptions& options)
    : instance_(Instance::create(validationWanted(options), options.surfaceExtensions, options.messages)),
      messages_(options.messages) {
    physical_ = choose(instance_ ? inspectAll(*instance_) : std::vector<PhysicalDevice>{}, options.select);
    instanceVk_ = instance_->vk();
    debugUtils_ = instance_->hasDebugUtils();
    instanceVk_.GetPhysicalDeviceMemoryProperties(physical_.handle, &memory_);
    presents_ = instance_->hasSurfaces() && physical_.drawsAndPresents;
    createDevice();
}

Context::Context(const AdoptedDevice& adopted)
    : instanceVk_(adoptedFunctions(adopted)),
      hooks_(adopted.memory),
      messages_(adopted.messages),
      debugUtils_(adopted.debugUtils) {
    physical_ = inspect(instanceVk_, adopted.physicalDevice, 0);
    if (!physical_.info.usable)
        throw Unsupported(
            formatText("{} cannot run Limpid: it lacks {}", physical_.info.name, physical_.info.whyNot));
    // The caller may not have enabled optional features, so use only the required ones.
    physical_.info.rayTracing = physical_.info.rayTracingCores = physical_.info.cooperativeMatrices = false;
    physical_.queueFamily = adopted.queueFamily;
    physical_.timestampValidBits = timestampBits(instanceVk_, adopted.physicalDevice, adopted.queueFamily);
    instanceVk_.GetPhysicalDeviceMemoryProperties(adopted.physicalDevice, &memory_);
    vk_ = DeviceFunctions(instanceVk_, adopted.device);
    require(vk_.CmdPipelineBarrier2, "vkCmdPipelineBarrier2");
    require(vk_.CmdWriteTimestamp2, "vkCmdWriteTimestamp2");
    debugUtils_ = debugUtils_ && vk_.SetDebugUtilsObjectNameEXT && vk_.CmdBeginDebugUtilsLabelEXT;
}

Context::~Context() {
    if (instance_ && vk_.device != VK_NULL_HANDLE) vk_.DestroyDevice(vk_.device, nullptr);
}

void Context::createDevice() {
    FeatureChain features;
    enableFeatures(instanceVk_, physical_, features);
    std::vector<const char*> extensions = wantedExtensions(physical_);
    if (presents_) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = physical_.queueFamily;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.pNext = &features.core;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VkDevice device = VK_NULL_HANDLE;
    LIMPID_VK(instanceVk_.CreateDevice(physical_.handle, &info, nullptr, &device));
    vk_ = DeviceFunctions(instanceVk_, device);
    vk().GetDeviceQueue(device, physical_.queueFamily, 0, &queue_);
    setName(device, "limpid device");
    setName(queue_, "limpid queue");
}

uint64_t Context::maxBufferBytes() const {
    return std::min(physical_.maxBufferSize, physical_.maxAllocation);
}

void Context::setName(VkObjectType type, uint64_t handle, const std::string& name) const {
    if (!hasDebugUtils()) return;
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = name.c_str();
    LIMPID_VK(vk().SetDebugUtilsObjectNameEXT(device(), &info));
}

void Context::submit(VkCommandBuffer commands, VkFence fence) const {
    if (!submits()) throw Error("frames are recorded on an adopted device, not executed");
    VkCommandBufferSubmitInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    buffer.commandBuffer = commands;
    VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &buffer;
    const std::lock_guard lock(queueMutex_);
    LIMPID_VK(vk().QueueSubmit2(queue_, 1, &info, fence));
}

void Context::waitIdle() const {
    const std::lock_guard lock(queueMutex_);
    LIMPID_VK(vk().DeviceWaitIdle(device()));
}

void Context::waitIdleNoThrow() const noexcept {
    const std::lock_guard lock(queueMutex_);
    const VkResult result = vk().DeviceWaitIdle(device());
    if (result == VK_SUCCESS || !messages_) return;
    try {
        messages_(MessageLevel::Error, "vkDeviceWaitIdle returned " + resultName(result));
    } catch (...) {
        // Called by a destructor, which cannot report errors.
    }
}

UniqueCommandPool makeCommandPool(const Context& context, const std::string& name) {
    VkCommandPoolCreateInfo info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    info.queueFamilyIndex = context.queueFamily();
    VkCommandPool pool = VK_NULL_HANDLE;
    LIMPID_VK(context.vk().CreateCommandPool(context.device(), &info, nullptr, &pool));
    UniqueCommandPool owned(context.vk(), pool);
    context.setName(pool, name);
    return owned;
}

VkCommandBuffer allocateCommandBuffer(const Context& context, VkCommandPool pool, const std::string& name) {
    VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    info.commandPool = pool;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    LIMPID_VK(context.vk().AllocateCommandBuffers(context.device(), &info, &commands));
    context.setName(commands, name);
    return commands;
}

void beginCommands(const Context& context, VkCommandBuffer commands) {
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    LIMPID_VK(context.vk().BeginCommandBuffer(commands, &info));
}

UniqueFence makeFence(const Context& context, const std::string& name) {
    const VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkFence fence = VK_NULL_HANDLE;
    LIMPID_VK(context.vk().CreateFence(context.device(), &info, nullptr, &fence));
    UniqueFence owned(context.vk(), fence);
    context.setName(fence, name);
    return owned;
}

void waitAndReset(const Context& context, VkFence fence) {
    LIMPID_VK(context.vk().WaitForFences(context.device(), 1, &fence, VK_TRUE, UINT64_MAX));
    LIMPID_VK(context.vk().ResetFences(context.device(), 1, &fence));
}

void passBarrier(const Context& context, VkCommandBuffer commands) {
    VkPipelineStageFlags2 stages = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    VkAccessFlags2 writes = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    VkAccessFlags2 reads = VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
    if (context.hasRayTracing()) {
        stages |= VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR |
                  VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
        writes |= VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR;
        // Builds read vertices and instances with shader-read access.
        reads |= VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR | VK_ACCESS_2_SHADER_READ_BIT;
    }
    memoryBarrier(context, commands, stages, writes, stages, reads | writes);
}

void memoryBarrier(const Context& context, VkCommandBuffer commands, VkPipelineStageFlags2 fromStage,
                   VkAccessFlags2 from, VkPipelineStageFlags2 toStage, VkAccessFlags2 to) {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = fromStage;
    barrier.srcAccessMask = from;
    barrier.dstStageMask = toStage;
    barrier.dstAccessMask = to;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    context.vk().CmdPipelineBarrier2(commands, &dependency);
}

}  // namespace limpid::gpu
