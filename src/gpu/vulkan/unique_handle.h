// A Vulkan object that is destroyed with its handle.
#pragma once

#include <utility>

#include "gpu/vulkan/functions.h"

namespace limpid::gpu {

/// `destroy` is the member of DeviceFunctions that destroys the object. The functions must outlive the
/// object: they belong to the Context, which all objects of a device share.
template <typename Handle, auto destroy>
class UniqueHandle {
  public:
    UniqueHandle() = default;
    UniqueHandle(const DeviceFunctions& vk, Handle handle) : vk_(&vk), handle_(handle) {}
    UniqueHandle(UniqueHandle&& other) noexcept
        : vk_(other.vk_), handle_(std::exchange(other.handle_, VK_NULL_HANDLE)) {}
    UniqueHandle& operator=(UniqueHandle&& other) noexcept {
        std::swap(vk_, other.vk_);
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~UniqueHandle() {
        if (handle_ != VK_NULL_HANDLE) (vk_->*destroy)(vk_->device, handle_, nullptr);
    }

    Handle get() const { return handle_; }
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

  private:
    const DeviceFunctions* vk_ = nullptr;
    Handle handle_ = VK_NULL_HANDLE;
};

using UniqueBuffer = UniqueHandle<VkBuffer, &DeviceFunctions::DestroyBuffer>;
using UniqueBufferView = UniqueHandle<VkBufferView, &DeviceFunctions::DestroyBufferView>;
using UniqueImage = UniqueHandle<VkImage, &DeviceFunctions::DestroyImage>;
using UniqueImageView = UniqueHandle<VkImageView, &DeviceFunctions::DestroyImageView>;
using UniqueMemory = UniqueHandle<VkDeviceMemory, &DeviceFunctions::FreeMemory>;
using UniqueCommandPool = UniqueHandle<VkCommandPool, &DeviceFunctions::DestroyCommandPool>;
using UniqueFence = UniqueHandle<VkFence, &DeviceFunctions::DestroyFence>;
using UniqueQueryPool = UniqueHandle<VkQueryPool, &DeviceFunctions::DestroyQueryPool>;
using UniqueDescriptorPool = UniqueHandle<VkDescriptorPool, &DeviceFunctions::DestroyDescriptorPool>;
using UniqueSetLayout = UniqueHandle<VkDescriptorSetLayout, &DeviceFunctions::DestroyDescriptorSetLayout>;
using UniquePipelineLayout = UniqueHandle<VkPipelineLayout, &DeviceFunctions::DestroyPipelineLayout>;
using UniqueDriverCache = UniqueHandle<VkPipelineCache, &DeviceFunctions::DestroyPipelineCache>;
using UniquePipeline = UniqueHandle<VkPipeline, &DeviceFunctions::DestroyPipeline>;
using UniqueSemaphore = UniqueHandle<VkSemaphore, &DeviceFunctions::DestroySemaphore>;
using UniqueSwapchain = UniqueHandle<VkSwapchainKHR, &DeviceFunctions::DestroySwapchainKHR>;
using UniqueAccelerationStructure =
    UniqueHandle<VkAccelerationStructureKHR, &DeviceFunctions::DestroyAccelerationStructureKHR>;
using UniqueShaderModule = UniqueHandle<VkShaderModule, &DeviceFunctions::DestroyShaderModule>;

/// The object types for debug names.
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
constexpr VkObjectType objectType(VkDescriptorSetLayout) {
    return VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT;
}
constexpr VkObjectType objectType(VkPipelineLayout) {
    return VK_OBJECT_TYPE_PIPELINE_LAYOUT;
}
constexpr VkObjectType objectType(VkPipeline) {
    return VK_OBJECT_TYPE_PIPELINE;
}
constexpr VkObjectType objectType(VkPipelineCache) {
    return VK_OBJECT_TYPE_PIPELINE_CACHE;
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
