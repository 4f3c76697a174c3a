// The logical device and everything that objects on it need. The objects share it, so that none outlives it.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "gpu/vulkan/adopted_device.h"
#include "gpu/vulkan/physical_device.h"
#include "gpu/vulkan/unique_handle.h"

namespace limpid::gpu {

class Context {
  public:
    explicit Context(const DeviceOptions& options);
    explicit Context(const AdoptedDevice& adopted);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    VkDevice device() const { return vk_.device; }
    const DeviceFunctions& vk() const { return vk_; }
    const InstanceFunctions& instanceVk() const { return instanceVk_; }
    /// Null for an adopted device.
    VkInstance instance() const { return instance_ ? instance_->handle() : VK_NULL_HANDLE; }
    VkPhysicalDevice physicalDevice() const { return physical_.handle; }
    /// True if it can present pictures in windows.
    bool presents() const { return presents_; }
    /// True if windows may have colour spaces other than sRGB.
    bool hasColorSpaces() const { return instance_ && instance_->hasColorSpaces(); }
    VkQueue queue() const { return queue_; }
    /// True if it has a queue of its own; false for an adopted device.
    bool submits() const { return queue_ != VK_NULL_HANDLE; }
    uint32_t queueFamily() const { return physical_.queueFamily; }
    uint32_t timestampValidBits() const { return physical_.timestampValidBits; }
    const DeviceInfo& info() const { return physical_.info; }
    const VkPhysicalDeviceLimits& limits() const { return physical_.limits; }
    uint64_t maxAllocation() const { return physical_.maxAllocation; }
    bool hasRayTracing() const { return physical_.info.rayTracing; }
    const RayTracingLimits& rayTracing() const { return physical_.rayTracing; }
    uint64_t maxBufferBytes() const;
    const VkPhysicalDeviceMemoryProperties& memoryProperties() const { return memory_; }
    /// Bytes of device memory currently allocated.
    const std::shared_ptr<std::atomic<uint64_t>>& allocated() const { return allocated_; }
    uint64_t validationMessages() const { return instance_ ? instance_->validationMessages() : 0; }
    const MemoryHooks& memoryHooks() const { return hooks_; }

    bool hasDebugUtils() const { return debugUtils_; }
    /// Names an object for validation messages and debuggers; does nothing without debug utils.
    template <typename Handle>
    void setName(Handle handle, const std::string& name) const {
        setName(objectType(handle), reinterpret_cast<uint64_t>(handle), name);
    }

    void submit(VkCommandBuffer commands, VkFence fence) const;
    void waitIdle() const;
    /// For destructors: logs failures instead of throwing.
    void waitIdleNoThrow() const noexcept;

  private:
    void createDevice();
    void setName(VkObjectType type, uint64_t handle, const std::string& name) const;

    std::unique_ptr<Instance> instance_;  ///< none for an adopted device
    InstanceFunctions instanceVk_;
    PhysicalDevice physical_;
    VkPhysicalDeviceMemoryProperties memory_{};
    DeviceFunctions vk_;
    MemoryHooks hooks_;
    MessageCallback messages_;
    bool debugUtils_ = false;
    VkQueue queue_ = VK_NULL_HANDLE;
    mutable std::mutex queueMutex_;  ///< a queue must not be used by two threads at once
    bool presents_ = false;
    std::shared_ptr<std::atomic<uint64_t>> allocated_ = std::make_shared<std::atomic<uint64_t>>(0);
};

UniqueCommandPool makeCommandPool(const Context& context, const std::string& name);
VkCommandBuffer allocateCommandBuffer(const Context& context, VkCommandPool pool, const std::string& name);
void beginCommands(const Context& context, VkCommandBuffer commands);
UniqueFence makeFence(const Context& context, const std::string& name);
void waitAndReset(const Context& context, VkFence fence);

/// Makes writes of earlier passes (shaders and acceleration-structure builds) visible to later passes, and
/// lets those overwrite what was read.
void passBarrier(const Context& context, VkCommandBuffer commands);
/// A global memory barrier. Images stay in GENERAL layout, so image barriers are never needed.
void memoryBarrier(const Context& context, VkCommandBuffer commands, VkPipelineStageFlags2 fromStage,
                   VkAccessFlags2 from, VkPipelineStageFlags2 toStage, VkAccessFlags2 to);

}  // namespace limpid::gpu
