// A Vulkan object that destroys itself with its device.
#pragma once

#include <memory>
#include <utility>

#include "gpu/vulkan/vk.h"

namespace limpid::gpu {

template <typename Handle, auto& destroy>
class UniqueHandle {
  public:
    UniqueHandle() = default;
    UniqueHandle(VkDevice device, Handle handle) : device_(device), handle_(handle) {}
    UniqueHandle(UniqueHandle&& other) noexcept
        : device_(other.device_), handle_(std::exchange(other.handle_, VK_NULL_HANDLE)) {}
    UniqueHandle& operator=(UniqueHandle&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~UniqueHandle() {
        if (handle_ != VK_NULL_HANDLE) destroy(device_, handle_, nullptr);
    }

    Handle get() const { return handle_; }
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

  private:
    VkDevice device_ = VK_NULL_HANDLE;
    Handle handle_ = VK_NULL_HANDLE;
};

using UniqueBuffer = UniqueHandle<VkBuffer, vkDestroyBuffer>;
using UniqueBufferView = UniqueHandle<VkBufferView, vkDestroyBufferView>;
using UniqueImage = UniqueHandle<VkImage, vkDestroyImage>;
using UniqueImageView = UniqueHandle<VkImageView, vkDestroyImageView>;
using UniqueMemory = UniqueHandle<VkDeviceMemory, vkFreeMemory>;
using UniqueCommandPool = UniqueHandle<VkCommandPool, vkDestroyCommandPool>;
using UniqueFence = UniqueHandle<VkFence, vkDestroyFence>;
using UniqueQueryPool = UniqueHandle<VkQueryPool, vkDestroyQueryPool>;
using UniqueDescriptorPool = UniqueHandle<VkDescriptorPool, vkDestroyDescriptorPool>;
using UniqueSetLayout = UniqueHandle<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;
using UniquePipelineLayout = UniqueHandle<VkPipelineLayout, vkDestroyPipelineLayout>;
using UniquePipeline = UniqueHandle<VkPipeline, vkDestroyPipeline>;
using UniqueSemaphore = UniqueHandle<VkSemaphore, vkDestroySemaphore>;
using UniqueSwapchain = UniqueHandle<VkSwapchainKHR, vkDestroySwapchainKHR>;
using UniqueAccelerationStructure =
    UniqueHandle<VkAccelerationStructureKHR, vkDestroyAccelerationStructureKHR>;
using UniqueShaderModule = UniqueHandle<VkShaderModule, vkDestroyShaderModule>;

/// Instances and devices have no parent to be destroyed with.
struct InstanceDeleter {
    void operator()(VkInstance instance) const { vkDestroyInstance(instance, nullptr); }
};
struct DeviceDeleter {
    void operator()(VkDevice device) const { vkDestroyDevice(device, nullptr); }
};
using UniqueInstance = std::unique_ptr<VkInstance_T, InstanceDeleter>;
using UniqueDevice = std::unique_ptr<VkDevice_T, DeviceDeleter>;

/// What a debug name is attached to.
constexpr VkObjectType objectType(VkBuffer) {
    return VK_OBJECT_TYPE_BUFFER;
}
constexpr VkObjectType objectType(VkBufferView) {
    return VK_OBJECT_TYPE_BUFFER_VIEW;
}
constexpr VkObjectType objectType(VkImage) {
    return VK_OBJECT_TYPE_IMAGE;
}
constexpr VkObjectType objectType(VkImageView) {
    return VK_OBJECT_TYPE_IMAGE_VIEW;
}
constexpr VkObjectType objectType(VkDeviceMemory) {
    return VK_OBJECT_TYPE_DEVICE_MEMORY;
}
constexpr VkObjectType objectType(VkCommandPool) {
    return VK_OBJECT_TYPE_COMMAND_POOL;
}
constexpr VkObjectType objectType(VkCommandBuffer) {
    return VK_OBJECT_TYPE_COMMAND_BUFFER;
}
constexpr VkObjectType objectType(VkFence) {
    return VK_OBJECT_TYPE_FENCE;
}
constexpr VkObjectType objectType(VkQueryPool) {
    return VK_OBJECT_TYPE_QUERY_POOL;
}
constexpr VkObjectType objectType(VkDescriptorPool) {
    return VK_OBJECT_TYPE_DESCRIPTOR_POOL;
}
constexpr VkObjectType objectType(VkDescriptorSet) {
    return VK_OBJECT_TYPE_DESCRIPTOR_SET;
}
constexpr VkObjectType objectType(VkDescriptorSetLayout) {
    return VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT;
}
constexpr VkObjectType objectType(VkPipelineLayout) {
    return VK_OBJECT_TYPE_PIPELINE_LAYOUT;
}
constexpr VkObjectType objectType(VkPipeline) {
    return VK_OBJECT_TYPE_PIPELINE;
}
constexpr VkObjectType objectType(VkShaderModule) {
    return VK_OBJECT_TYPE_SHADER_MODULE;
}
constexpr VkObjectType objectType(VkAccelerationStructureKHR) {
    return VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR;
}
constexpr VkObjectType objectType(VkQueue) {
    return VK_OBJECT_TYPE_QUEUE;
}
constexpr VkObjectType objectType(VkDevice) {
    return VK_OBJECT_TYPE_DEVICE;
}

}  // namespace limpid::gpu
