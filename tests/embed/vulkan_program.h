// A fixture for tests of the C interface in a Vulkan program, on the program's device and in its command
// buffers. The tests' own device acts as the program's; its validation layer checks both.
#pragma once

#include <gtest/gtest.h>

#include <map>

#include "denoise/api/c_handles.h"
#include "gpu/vulkan/device_impl.h"
#include "gpu/vulkan/memory/format.h"
#include "gpu/vulkan/memory/image.h"
#include "limpid/denoise_vulkan.h"
#include "tests/denoise/denoise_fixture.h"
#include "tests/embed/synthetic_camera.h"

namespace limpid::test {

constexpr uint32_t width = 40, height = 24;

/// Images of one frame on the program's device, and the frame as limpid_record() takes it.
struct ProgramFrame {
    gpu::FrameGraph graph;  ///< owns the images
    limpid_vulkan_frame frame = {sizeof frame};
    gpu::ImageHandle color;
};

class VulkanProgramTest : public DenoiseTest {
  protected:
    void SetUp() override {
        DenoiseTest::SetUp();
        if (IsSkipped() || adopted_) return;
        ASSERT_EQ(adopt({}), LIMPID_OK) << limpid_last_error();
    }
    void TearDown() override {
        if (!IsSkipped()) device().waitIdle();
        for (limpid_denoiser* denoiser : denoisers_) limpid_denoiser_destroy(denoiser);
        DenoiseTest::TearDown();
    }
    static void TearDownTestSuite() { limpid_device_destroy(std::exchange(adopted_, nullptr)); }

    const gpu::Context& program() { return *device().impl().context; }

    limpid_result adopt(limpid_vulkan_device_desc desc) {
        limpid_device_destroy(std::exchange(adopted_, nullptr));
        desc.size = sizeof desc;
        desc.instance = program().instance();
        desc.physical_device = program().physicalDevice();
        desc.device = program().device();
        if (desc.queue_family == 0) desc.queue_family = program().queueFamily();
        if (!desc.get_instance_proc_addr) desc.get_instance_proc_addr = gpu::systemLoader();
        desc.debug_utils = program().hasDebugUtils();
        return limpid_device_adopt(&desc, &adopted_);
    }

    limpid_denoiser* create(limpid_denoiser_desc desc = {}) {
        desc.size = sizeof desc;
        if (desc.width == 0) desc.width = width, desc.height = height;
        if (desc.signals == 0) desc.signals = 2;
        desc.motion_depth = LIMPID_MOTION_DISTANCE;
        limpid_denoiser* denoiser = nullptr;
        EXPECT_EQ(limpid_denoiser_create(adopted_, &desc, &denoiser), LIMPID_OK) << limpid_last_error();
        denoisers_.push_back(denoiser);
        return denoiser;
    }

    limpid_vulkan_image imageOf(ProgramFrame& f, gpu::ImageHandle handle, VkFormat format) {
        const gpu::Image& image = f.graph.imageOnDevice(device(), handle);
        limpid_vulkan_image result = {};
        result.image = image.image.get();
        result.view = image.view.get();
        result.format = format;
        result.layout = VK_IMAGE_LAYOUT_GENERAL;
        result.stages_before = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
        result.access_before = VK_ACCESS_2_TRANSFER_WRITE_BIT;
        return result;
    }

    /// Uploads the inputs, and fills the output with -1.
    using Pixels = std::map<limpid_input, std::pair<gpu::Format, std::span<const std::byte>>>;
    std::unique_ptr<ProgramFrame> upload(const Pixels& inputs, gpu::Extent extent) {
        auto f = std::make_unique<ProgramFrame>();
        f->graph.beginFrame();
        std::map<limpid_input, gpu::ImageHandle> images;
        for (const auto& [input, pixels] : inputs) {
            images[input] = f->graph.transient("program/" + std::to_string(input), pixels.first, extent);
            f->graph.upload(images[input], pixels.second);
        }
        const size_t values = size_t{4} * extent.width * extent.height;
        const bool half = colorFormat_ == gpu::Format::RGBA16Float;
        f->color = f->graph.transient("program/color", colorFormat_, extent);
        if (half)
            f->graph.upload(f->color, gpu::bytesOf(std::vector<uint16_t>(values, 0xBC00)));
        else
            f->graph.upload(f->color, gpu::bytesOf(std::vector<float>(values, -1.0f)));
        f->graph.execute(device());
        for (const auto& [input, handle] : images)
            f->frame.inputs[input] = imageOf(*f, handle, gpu::toVulkan(inputs.at(input).first));
        limpid_vulkan_image& output = f->frame.outputs[LIMPID_OUTPUT_COLOR];
        output = imageOf(*f, f->color, half ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT);
        output.layout_after = VK_IMAGE_LAYOUT_GENERAL;
        output.stages_after = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
        output.access_after = VK_ACCESS_2_TRANSFER_READ_BIT;
        return f;
    }

    /// Uploads frame `number` of a scene. The upload is complete when this returns.
    std::unique_ptr<ProgramFrame> upload(const SyntheticScene& scene, int number,
                                         gpu::Extent extent = {width, height}) {
        const HostFrame host = scene.frame(number, extent.width, extent.height, 1);
        std::vector<float> depths(host.pixelCount());
        std::vector<uint32_t> ids(host.pixelCount());
        for (size_t p = 0; p < host.pixelCount(); ++p) {
            depths[p] = host.depth[4 * p + 1] > 0.0f ? host.depth[4 * p] / host.depth[4 * p + 1] : 0.0f;
            ids[p] = host.ids[2 * p];
        }
        constexpr auto color = gpu::Format::RGBA32Float;
        auto f = upload({{LIMPID_INPUT_RADIANCE, {color, gpu::bytesOf(host.diffuse)}},
                         {LIMPID_INPUT_SPECULAR, {color, gpu::bytesOf(host.specular)}},
                         {LIMPID_INPUT_EMISSION, {color, gpu::bytesOf(host.emission)}},
                         {LIMPID_INPUT_ALBEDO, {color, gpu::bytesOf(host.albedo)}},
                         {LIMPID_INPUT_ALBEDO_SPECULAR, {color, gpu::bytesOf(host.albedoSpecular)}},
                         {LIMPID_INPUT_NORMAL, {color, gpu::bytesOf(host.normal)}},
                         {LIMPID_INPUT_DEPTH, {gpu::Format::R32Float, gpu::bytesOf(depths)}},
                         {LIMPID_INPUT_MOTION, {color, gpu::bytesOf(host.motion)}},
                         {LIMPID_INPUT_PREVIOUS_NORMAL, {color, gpu::bytesOf(host.previousNormal)}},
                         {LIMPID_INPUT_ID, {gpu::Format::R32Uint, gpu::bytesOf(ids)}}},
                        extent);
        f->frame.camera = matricesOf(host.camera, host.camera);
        return f;
    }

    /// Lets `record` record into a command buffer of the program, submits it and waits.
    void run(const std::function<void(VkCommandBuffer)>& record) { device().impl().transfer().run(record); }

    std::vector<float> pixels(ProgramFrame& f) { return f.graph.downloadFloat(device(), f.color); }

    std::vector<float> denoiseSequence(limpid_denoiser* denoiser, const SyntheticScene& scene, int frames) {
        std::vector<float> last;
        for (int number = 0; number < frames; ++number) {
            const auto f = upload(scene, number);
            run([&](VkCommandBuffer commands) {
                EXPECT_EQ(limpid_record(denoiser, commands, &f->frame), LIMPID_OK) << limpid_last_error();
            });
            last = pixels(*f);
        }
        return last;
    }

    inline static limpid_device* adopted_ =
        nullptr;  ///< shared by all tests, so that each shader is compiled once
    std::vector<limpid_denoiser*> denoisers_;
    gpu::Format colorFormat_ = gpu::Format::RGBA32Float;  ///< of the program's output
};

}  // namespace limpid::test
