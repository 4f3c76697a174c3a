// Tests the conversion for HDR surfaces on the device, against its formulas in double precision.
#include "gpu/present/surface_encoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>
#include <memory>
#include <vector>

#include "gpu/vulkan/device_impl.h"

namespace limpid::gpu {
namespace {

using Color = std::array<double, 3>;

class SurfaceEncoderTest : public testing::Test {
  protected:
    void SetUp() override {
        const char* const wanted = std::getenv("LIMPID_TEST_DEVICE");
        if (enumerateDevices().empty())
            GTEST_SKIP() << "NOT TESTED: this machine has no Vulkan device. Install mesa-vulkan-drivers.";
        device_ = std::make_unique<Device>(DeviceOptions{.select = wanted ? wanted : "cpu"});
    }

    /// What the encoder writes for a row of colours, in a surface's format that can be read back: 16-bit
    /// floats.
    std::vector<Color> encoded(const std::vector<Color>& colors, SurfaceEncoding encoding,
                               const HighRange& range) {
        const std::shared_ptr<const Context> context = device_->impl().context;
        Transfer& transfer = device_->impl().transfer();
        const Extent extent{static_cast<uint32_t>(colors.size()), 1};
        SurfaceEncoder encoder(context, {{VK_FORMAT_R16G16B16A16_SFLOAT, {}}, encoding});
        encoder.resize(extent);
        const Image target = makeImage(context, "target", Format::RGBA16Float, extent, Backing::Image,
                                       VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        std::vector<uint64_t> texels;
        for (const Color& c : colors) texels.push_back(glm::packHalf4x16(glm::vec4(c[0], c[1], c[2], 1.0)));
        const auto source = makeBuffer(context, "source", BufferUse::Storage, bytesOf(texels).size());
        transfer.upload(*source, bytesOf(texels));
        transfer.run([&](VkCommandBuffer commands) {
            toGeneral(commands, encoder.composed().image.get());
            toGeneral(commands, target.image.get());
            VkBufferImageCopy region{};
            region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.imageExtent = {extent.width, 1, 1};
            context->vk().CmdCopyBufferToImage(commands, source->buffer.get(), encoder.composed().image.get(),
                                               VK_IMAGE_LAYOUT_GENERAL, 1, &region);
            everything(commands);
            encoder.encode(commands, target.view.get(), VK_IMAGE_LAYOUT_GENERAL, range);
            everything(commands);
        });
        std::vector<uint64_t> result(colors.size());
        transfer.download(target, std::as_writable_bytes(std::span(result)));
        std::vector<Color> shown;
        for (const uint64_t texel : result) {
            const glm::vec4 v = glm::unpackHalf4x16(texel);
            EXPECT_EQ(v.a, 1.0f);
            shown.push_back({double{v.r}, double{v.g}, double{v.b}});
        }
        EXPECT_EQ(device_->validationMessages(), 0u);
        return shown;
    }

  private:
    void everything(VkCommandBuffer commands) const {
        memoryBarrier(*device_->impl().context, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                      VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                      VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
    }
    void toGeneral(VkCommandBuffer commands, VkImage image) const {
        VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
        barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
        barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = image;
        barrier.subresourceRange = wholeImage();
        VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        info.imageMemoryBarrierCount = 1;
        info.pImageMemoryBarriers = &barrier;
        device_->impl().context->vk().CmdPipelineBarrier2(commands, &info);
    }

    std::unique_ptr<Device> device_;
};

double srgbEncoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

Color gray(double linear) {
    const double v = srgbEncoded(linear);
    return {v, v, v};
}

/// SMPTE ST 2084, of cd/m^2.
double pq(double luminance) {
    const double power = std::pow(luminance / 10000.0, 0.1593017578125);
    return std::pow((0.8359375 + 18.8515625 * power) / (1.0 + 18.6875 * power), 78.84375);
}

void expectColor(const Color& shown, const Color& wanted) {
    for (size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(shown[c], wanted[c], 2e-3 * std::max(wanted[c], 0.05)) << "channel " << c;
}

/// 1 is 80 cd/m^2: white is at 203 / 80, four times that is 812 cd/m^2, and what exceeds the peak is clipped.
TEST_F(SurfaceEncoderTest, ScRgbIsLinearLightOverEighty) {
    const std::vector<Color> shown =
        encoded({gray(0.0), gray(0.18), gray(1.0), gray(4.0), gray(50.0), {1.0, 0.0, 0.5}},
                SurfaceEncoding::ScRgb, {.paperWhite = 203.0f, .peak = 1000.0f});
    expectColor(shown[0], {0.0, 0.0, 0.0});
    expectColor(shown[1], {0.45675, 0.45675, 0.45675});
    expectColor(shown[2], {2.5375, 2.5375, 2.5375});
    expectColor(shown[3], {10.15, 10.15, 10.15});
    expectColor(shown[4], {12.5, 12.5, 12.5});
    const double half = 2.5375 * std::pow((0.5 + 0.055) / 1.055, 2.4);
    expectColor(shown[5], {2.5375, 0.0, half});
}

/// Numbers of the PQ curve from BT.2408: 203 cd/m^2 is 58 % and 1,000 is 75 % of the signal.
TEST_F(SurfaceEncoderTest, Hdr10IsThePqCurveOfRec2020) {
    const std::vector<Color> shown = encoded({gray(1.0), gray(1000.0 / 203.0), gray(100.0), {1.0, 0.0, 0.0}},
                                             SurfaceEncoding::Hdr10, {.paperWhite = 203.0f, .peak = 1000.0f});
    expectColor(shown[0], {0.5807, 0.5807, 0.5807});
    expectColor(shown[1], {0.7518, 0.7518, 0.7518});
    expectColor(shown[2], {0.7518, 0.7518, 0.7518});
    expectColor(shown[3], {pq(203.0 * 0.6274), pq(203.0 * 0.0691), pq(203.0 * 0.0164)});
}

}  // namespace
}  // namespace limpid::gpu
