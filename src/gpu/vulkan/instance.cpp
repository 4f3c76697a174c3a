#include "gpu/vulkan/instance.h"

#include <algorithm>
#include <string_view>

#include "base/error.h"
#include "gpu/vulkan/check.h"

namespace limpid::gpu {
namespace {

constexpr const char* validationLayer = "VK_LAYER_KHRONOS_validation";

bool layerInstalled(const LoaderFunctions& loader) {
    uint32_t count = 0;
    LIMPID_VK(loader.EnumerateInstanceLayerProperties(&count, nullptr));
    std::vector<VkLayerProperties> layers(count);
    LIMPID_VK(loader.EnumerateInstanceLayerProperties(&count, layers.data()));
    return std::ranges::any_of(
        layers, [](const VkLayerProperties& l) { return std::string_view(l.layerName) == validationLayer; });
}

bool hasExtension(const LoaderFunctions& loader, const char* layer, std::string_view name) {
    uint32_t count = 0;
    LIMPID_VK(loader.EnumerateInstanceExtensionProperties(layer, &count, nullptr));
    std::vector<VkExtensionProperties> extensions(count);
    LIMPID_VK(loader.EnumerateInstanceExtensionProperties(layer, &count, extensions.data()));
    return std::ranges::any_of(extensions,
                               [&](const VkExtensionProperties& e) { return name == e.extensionName; });
}

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                         VkDebugUtilsMessageTypeFlagsEXT type,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto& messages = *static_cast<Instance::Messages*>(user);
    // Not counted as errors: performance advice, since it contradicts our decision to keep images in GENERAL
    // layout, and messages of the loader (for example, about a broken driver file).
    if (!(type & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT)) {
        if (messages.callback)
            messages.callback(MessageLevel::Debug, std::string("Vulkan: ") + data->pMessage);
        return VK_FALSE;
    }
    ++messages.count;
    const bool error = severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    if (messages.callback)
        messages.callback(error ? MessageLevel::Error : MessageLevel::Warning,
                          std::string("Vulkan validation: ") + data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(Instance::Messages* messages) {
    VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = onMessage;
    info.pUserData = messages;
    return info;
}

}  // namespace

std::unique_ptr<Instance> Instance::create(bool validation, const std::vector<std::string>& surfaceExtensions,
                                           const MessageCallback& messages) {
    const PFN_vkGetInstanceProcAddr getInstanceProcAddr = systemLoader();
    if (!getInstanceProcAddr) return nullptr;
    const LoaderFunctions loader(getInstanceProcAddr);
    uint32_t version = VK_API_VERSION_1_0;
    if (loader.EnumerateInstanceVersion) LIMPID_VK(loader.EnumerateInstanceVersion(&version));
    if (version < VK_API_VERSION_1_1) return nullptr;
    if (validation && !layerInstalled(loader)) {
        throw Error(
            "Vulkan validation is asked for, but the Khronos validation layer is not installed "
            "(Debian package vulkan-validationlayers)");
    }
    std::unique_ptr<Instance> self(new Instance);
    self->messages_->callback = messages;
    self->debugUtils_ =
        hasExtension(loader, nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) ||
        (validation && hasExtension(loader, validationLayer, VK_EXT_DEBUG_UTILS_EXTENSION_NAME));

    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(self->messages_.get());
    const VkValidationFeatureEnableEXT enabled[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = enabled;
    std::vector<const char*> extensions;
    if (self->debugUtils_) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    if (validation) extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);

    self->surfaces_ =
        !surfaceExtensions.empty() && std::ranges::all_of(surfaceExtensions, [&](const std::string& name) {
            return hasExtension(loader, nullptr, name);
        });
    if (self->surfaces_) {
        for (const std::string& name : surfaceExtensions) extensions.push_back(name.c_str());
        self->colorSpaces_ = hasExtension(loader, nullptr, VK_EXT_SWAPCHAIN_COLOR_SPACE_EXTENSION_NAME);
        if (self->colorSpaces_) extensions.push_back(VK_EXT_SWAPCHAIN_COLOR_SPACE_EXTENSION_NAME);
    }

    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "limpid";
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    info.enabledLayerCount = validation ? 1 : 0;
    info.ppEnabledLayerNames = &validationLayer;
    if (validation) {
        features.pNext = &messenger;  // also counts messages while the instance itself is created and
                                      // destroyed
        info.pNext = &features;
    }
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = loader.CreateInstance(&info, nullptr, &instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) return nullptr;
    LIMPID_VK(result);
    self->instance_ = instance;
    self->vk_ = InstanceFunctions(getInstanceProcAddr, instance);
    if (validation) self->createMessenger();
    return self;
}

void Instance::createMessenger() {
    const VkDebugUtilsMessengerCreateInfoEXT info = messengerInfo(messages_.get());
    LIMPID_VK(vk_.CreateDebugUtilsMessengerEXT(instance_, &info, nullptr, &messenger_));
}

Instance::~Instance() {
    if (messenger_ != VK_NULL_HANDLE) vk_.DestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
    if (instance_ != VK_NULL_HANDLE) vk_.DestroyInstance(instance_, nullptr);
}

std::vector<VkPhysicalDevice> Instance::physicalDevices() const {
    uint32_t count = 0;
    const VkResult result = vk_.EnumeratePhysicalDevices(instance_, &count, nullptr);
    // Some loaders return this if every driver failed to load.
    if (result == VK_ERROR_INITIALIZATION_FAILED) return {};
    LIMPID_VK(result);
    std::vector<VkPhysicalDevice> devices(count);
    LIMPID_VK(vk_.EnumeratePhysicalDevices(instance_, &count, devices.data()));
    devices.resize(count);
    return devices;
}

}  // namespace limpid::gpu
