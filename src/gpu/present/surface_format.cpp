#include "gpu/present/surface_format.h"

#include <algorithm>

namespace limpid::gpu {
namespace {

std::optional<SurfaceFormat> firstOffered(std::span<const VkSurfaceFormatKHR> offered,
                                          std::span<const SurfaceFormat> wanted) {
    for (const SurfaceFormat& candidate : wanted) {
        const bool found = std::ranges::any_of(offered, [&](const VkSurfaceFormatKHR& one) {
            return one.format == candidate.vulkan.format && one.colorSpace == candidate.vulkan.colorSpace;
        });
        if (found) return candidate;
    }
    return std::nullopt;
}

}  // namespace

std::optional<SurfaceFormat> standardFormat(std::span<const VkSurfaceFormatKHR> offered) {
    constexpr VkColorSpaceKHR space = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    static const SurfaceFormat wanted[] = {
        {{VK_FORMAT_B8G8R8A8_UNORM, space}, SurfaceEncoding::Srgb},
        {{VK_FORMAT_R8G8B8A8_UNORM, space}, SurfaceEncoding::Srgb},
        {{VK_FORMAT_A2B10G10R10_UNORM_PACK32, space}, SurfaceEncoding::Srgb},
    };
    return firstOffered(offered, wanted);
}

std::optional<SurfaceFormat> highRangeFormat(std::span<const VkSurfaceFormatKHR> offered) {
    static const SurfaceFormat wanted[] = {
        {{VK_FORMAT_R16G16B16A16_SFLOAT, VK_COLOR_SPACE_EXTENDED_SRGB_LINEAR_EXT}, SurfaceEncoding::ScRgb},
        {{VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_COLOR_SPACE_HDR10_ST2084_EXT}, SurfaceEncoding::Hdr10},
        {{VK_FORMAT_A2R10G10B10_UNORM_PACK32, VK_COLOR_SPACE_HDR10_ST2084_EXT}, SurfaceEncoding::Hdr10},
    };
    return firstOffered(offered, wanted);
}

}  // namespace limpid::gpu
