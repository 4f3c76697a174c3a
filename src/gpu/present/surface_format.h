// Which of the formats that a surface offers a window is shown in.
#pragma once

#include <optional>
#include <span>

#include "gpu/vulkan/vk.h"

namespace limpid::gpu {

/// What the numbers in a surface's pixels mean.
enum class SurfaceEncoding : uint32_t {
    Srgb,   ///< sRGB, 0 to 1: pictures of the standard range, as they are
    ScRgb,  ///< linear, with the primaries of sRGB; 1 is 80 cd/m^2 (IEC 61966-2-2)
    Hdr10,  ///< primaries of Rec. 2020, the PQ curve of SMPTE ST 2084; 1 is 10,000 cd/m^2
};

struct SurfaceFormat {
    VkSurfaceFormatKHR vulkan{};
    SurfaceEncoding encoding{};
};

/// Of a list as vkGetPhysicalDeviceSurfaceFormatsKHR returns it. None: the list has no such format.
///
/// 8 bits rather than 10, and none that encodes what is written: pictures are encoded already.
std::optional<SurfaceFormat> standardFormat(std::span<const VkSurfaceFormatKHR> offered);
/// With a range beyond that of sRGB: 16-bit scRGB, else 10-bit HDR10.
std::optional<SurfaceFormat> highRangeFormat(std::span<const VkSurfaceFormatKHR> offered);

}  // namespace limpid::gpu
