// The logical device and what every object made on it needs. Shared by the objects, so that none outlives it.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "gpu/vulkan/physical_device.h"
#include "gpu/vulkan/unique_handle.h"

namespace limpid::gpu {

class Context {
  public:
    explicit Context(const DeviceOptions& options);

    VkDevice device() const { return device_.get(); }
    VkInstance instance() const { return instance_->handle(); }
    VkPhysicalDevice physicalDevice() const { return physical_.handle; }
    /// It may show pictures in windows.
    bool presents() const { return presents_; }
    VkQueue queue() const { return queue_; }
    uint32_t queueFamily() const { return physical_.queueFamily; }
    uint32_t timestampValidBits() const { return physical_.timestampValidBits; }
    const DeviceInfo& info() const { return physical_.info; }
    const VkPhysicalDeviceLimits& limits() const { return physical_.limits; }
    uint64_t maxAllocation() const { return physical_.maxAllocation; }
    bool hasRayTracing() const { return physical_.info.rayTracing; }
    const RayTracingLimits& rayTracing() const { return physical_.rayTracing; }
    uint64_t maxBufferBytes() const;
    const VkPhysicalDeviceMemoryProperties& memoryProperties() const { return memory_; }
    /// Bytes of device memory that are allocated now.
    const std::shared_ptr<std::atomic<uint64_t>>& allocated() const { return allocated_; }
    uint64_t validationMessages() const { return instance_->validationMessages(); }

    bool hasDebugUtils() const { return instance_->hasDebugUtils(); }
    /// Names an object for validation messages and debuggers; nothing where debug utils are absent.
    template <typename Handle>
    void setName(Handle handle, const std::string& name) const {
        setName(objectType(handle), reinterpret_cast<uint64_t>(handle), name);
    }

    void submit(VkCommandBuffer commands, VkFence fence) const;
    void waitIdle() const;
    /// For destructors: failures are logged.
    void waitIdleNoThrow() const noexcept;

  private:
    void createDevice();
    void setName(VkObjectType type, uint64_t handle, const std::string& name) const;

    std::unique_ptr<Instance> instance_;
    PhysicalDevice physical_;
    VkPhysicalDeviceMemoryProperties memory_{};
    UniqueDevice device_;
    VkQueue queue_ = VK_NULL_HANDLE;
    bool presents_ = false;
    std::shared_ptr<std::atomic<uint64_t>> allocated_ = std::make_shared<std::atomic<uint64_t>>(0);
};

UniqueCommandPool makeCommandPool(const Context& context, const std::string& name);
VkCommandBuffer allocateCommandBuffer(const Context& context, VkCommandPool pool, const std::string& name);
void beginCommands(VkCommandBuffer commands);
UniqueFence makeFence(const Context& context, const std::string& name);
void waitAndReset(const Context& context, VkFence fence);

/// What earlier passes wrote, later passes may use and overwrite: shaders, and builds of acceleration
/// structures.
void passBarrier(const Context& context, VkCommandBuffer commands);
/// A global memory barrier; images stay in GENERAL layout, so nothing finer is ever needed.
void memoryBarrier(VkCommandBuffer commands, VkPipelineStageFlags2 fromStage, VkAccessFlags2 from,
                   VkPipelineStageFlags2 toStage, VkAccessFlags2 to);

}  // namespace limpid::gpu
