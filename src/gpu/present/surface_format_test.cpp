// Tests the choice of a surface's format with lists as drivers report them, and the conversion for HDR.
#include "gpu/present/surface_format.h"

#include <gtest/gtest.h>

#include <vector>

namespace limpid::gpu {
namespace {

using Formats = std::vector<VkSurfaceFormatKHR>;

constexpr VkColorSpaceKHR srgb = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR,
                          scrgb = VK_COLOR_SPACE_EXTENDED_SRGB_LINEAR_EXT,
                          hdr10 = VK_COLOR_SPACE_HDR10_ST2084_EXT;

// In the order of vulkaninfo on such systems.
const Formats mesaX11{{VK_FORMAT_B8G8R8A8_SRGB, srgb}, {VK_FORMAT_B8G8R8A8_UNORM, srgb}};
const Formats amdWindows{
    {VK_FORMAT_R8G8B8A8_UNORM, srgb},           {VK_FORMAT_R8G8B8A8_SRGB, srgb},
    {VK_FORMAT_B8G8R8A8_UNORM, srgb},           {VK_FORMAT_B8G8R8A8_SRGB, srgb},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, srgb}, {VK_FORMAT_A2R10G10B10_UNORM_PACK32, srgb},
    {VK_FORMAT_R16G16B16A16_SFLOAT, scrgb},     {VK_FORMAT_A2B10G10R10_UNORM_PACK32, hdr10},
    {VK_FORMAT_A2R10G10B10_UNORM_PACK32, hdr10}};
const Formats nvidiaWindows{
    {VK_FORMAT_B8G8R8A8_UNORM, srgb},           {VK_FORMAT_B8G8R8A8_SRGB, srgb},
    {VK_FORMAT_R8G8B8A8_UNORM, srgb},           {VK_FORMAT_R8G8B8A8_SRGB, srgb},
    {VK_FORMAT_R16G16B16A16_SFLOAT, scrgb},     {VK_FORMAT_A2B10G10R10_UNORM_PACK32, srgb},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, hdr10}};
const Formats nvidiaX11{{VK_FORMAT_B8G8R8A8_UNORM, srgb},
                        {VK_FORMAT_B8G8R8A8_SRGB, srgb},
                        {VK_FORMAT_A2R10G10B10_UNORM_PACK32, srgb}};
const Formats mesaWayland{{VK_FORMAT_B8G8R8A8_SRGB, srgb},
                          {VK_FORMAT_B8G8R8A8_UNORM, srgb},
                          {VK_FORMAT_A2B10G10R10_UNORM_PACK32, srgb},
                          {VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_COLOR_SPACE_DISPLAY_P3_NONLINEAR_EXT},
                          {VK_FORMAT_A2R10G10B10_UNORM_PACK32, hdr10},
                          {VK_FORMAT_R16G16B16A16_SFLOAT, VK_COLOR_SPACE_PASS_THROUGH_EXT}};

void expectFormat(const std::optional<SurfaceFormat>& chosen, VkFormat format, VkColorSpaceKHR space,
                  SurfaceEncoding encoding) {
    ASSERT_TRUE(chosen);
    EXPECT_EQ(chosen->vulkan.format, format);
    EXPECT_EQ(chosen->vulkan.colorSpace, space);
    EXPECT_EQ(chosen->encoding, encoding);
}

TEST(SurfaceFormat, StandardIsEightBitsThatAreNotEncodedAgain) {
    for (const Formats& list : {mesaX11, amdWindows, nvidiaWindows, nvidiaX11, mesaWayland})
        expectFormat(standardFormat(list), VK_FORMAT_B8G8R8A8_UNORM, srgb, SurfaceEncoding::Srgb);
    const Formats android{{VK_FORMAT_R8G8B8A8_SRGB, srgb}, {VK_FORMAT_R8G8B8A8_UNORM, srgb}};
    expectFormat(standardFormat(android), VK_FORMAT_R8G8B8A8_UNORM, srgb, SurfaceEncoding::Srgb);
    EXPECT_FALSE(standardFormat(Formats{{VK_FORMAT_B8G8R8A8_SRGB, srgb}}));
    EXPECT_FALSE(standardFormat(Formats{{VK_FORMAT_B8G8R8A8_UNORM, scrgb}}));
    EXPECT_FALSE(standardFormat({}));
}

TEST(SurfaceFormat, AHighRangeIsScRgbOrElseHdr10) {
    expectFormat(highRangeFormat(amdWindows), VK_FORMAT_R16G16B16A16_SFLOAT, scrgb, SurfaceEncoding::ScRgb);
    expectFormat(highRangeFormat(nvidiaWindows), VK_FORMAT_R16G16B16A16_SFLOAT, scrgb,
                 SurfaceEncoding::ScRgb);
    expectFormat(highRangeFormat(mesaWayland), VK_FORMAT_A2R10G10B10_UNORM_PACK32, hdr10,
                 SurfaceEncoding::Hdr10);
    const Formats both{{VK_FORMAT_A2R10G10B10_UNORM_PACK32, hdr10},
                       {VK_FORMAT_A2B10G10R10_UNORM_PACK32, hdr10}};
    expectFormat(highRangeFormat(both), VK_FORMAT_A2B10G10R10_UNORM_PACK32, hdr10, SurfaceEncoding::Hdr10);
}

/// A format alone is none: 16-bit floats may be meant as sRGB, or as anything (pass-through).
TEST(SurfaceFormat, NoHighRangeWithoutItsColorSpace) {
    EXPECT_FALSE(highRangeFormat(mesaX11));
    EXPECT_FALSE(highRangeFormat(nvidiaX11));
    EXPECT_FALSE(highRangeFormat(Formats{{VK_FORMAT_R16G16B16A16_SFLOAT, srgb},
                                         {VK_FORMAT_R16G16B16A16_SFLOAT, VK_COLOR_SPACE_PASS_THROUGH_EXT},
                                         {VK_FORMAT_R16G16B16A16_SFLOAT, VK_COLOR_SPACE_BT709_LINEAR_EXT},
                                         {VK_FORMAT_B8G8R8A8_UNORM, scrgb},
                                         {VK_FORMAT_B8G8R8A8_UNORM, hdr10}}));
    EXPECT_FALSE(highRangeFormat({}));
}

}  // namespace
}  // namespace limpid::gpu
