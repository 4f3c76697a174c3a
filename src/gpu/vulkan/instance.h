// The Vulkan instance: the loader, the validation layer and its messages.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "base/message.h"
#include "gpu/vulkan/functions.h"

namespace limpid::gpu {

class Instance {
  public:
    /// Returns null if this machine has no Vulkan loader, or the loader finds no driver. Throws Error if
    /// `validation` is requested but the layer is not installed. `surfaceExtensions`: see DeviceOptions.
    static std::unique_ptr<Instance> create(bool validation,
                                            const std::vector<std::string>& surfaceExtensions = {},
                                            const MessageCallback& messages = {});
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    std::vector<VkPhysicalDevice> physicalDevices() const;
    /// True if VK_EXT_debug_utils is available: objects and passes get names.
    bool hasDebugUtils() const { return debugUtils_; }
    /// True if all requested surface extensions are available.
    bool hasSurfaces() const { return surfaces_; }
    /// True if surfaces may also offer colour spaces other than sRGB (VK_EXT_swapchain_colorspace).
    bool hasColorSpaces() const { return colorSpaces_; }
    VkInstance handle() const { return instance_; }
    const InstanceFunctions& vk() const { return vk_; }
    uint64_t validationMessages() const { return messages_->count; }

    /// Receives the validation layer's reports.
    struct Messages {
        std::atomic<uint64_t> count = 0;
        MessageCallback callback;
    };

  private:
    Instance() = default;
    void createMessenger();

    /// Outlives the instance, since destroying that may still produce messages.
    std::unique_ptr<Messages> messages_ = std::make_unique<Messages>();
    VkInstance instance_ = VK_NULL_HANDLE;
    InstanceFunctions vk_;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    bool debugUtils_ = false, surfaces_ = false, colorSpaces_ = false;
};

}  // namespace limpid::gpu
