#include "gpu/vulkan/memory/format.h"

namespace limpid::gpu {

VkFormat toVulkan(Format format) {
    switch (format) {
        case Format::R32Float:
            return VK_FORMAT_R32_SFLOAT;
        case Format::R32Uint:
            return VK_FORMAT_R32_UINT;
        case Format::RG32Float:
            return VK_FORMAT_R32G32_SFLOAT;
        case Format::RG32Uint:
            return VK_FORMAT_R32G32_UINT;
        case Format::RGBA32Float:
            return VK_FORMAT_R32G32B32A32_SFLOAT;
        case Format::RGBA32Uint:
            return VK_FORMAT_R32G32B32A32_UINT;
        case Format::R16Float:
            return VK_FORMAT_R16_SFLOAT;
        case Format::RGBA16Float:
            return VK_FORMAT_R16G16B16A16_SFLOAT;
        case Format::RGBA8Unorm:
            return VK_FORMAT_R8G8B8A8_UNORM;
    }
    return VK_FORMAT_UNDEFINED;
}

}  // namespace limpid::gpu
