// Tests images that the CPU fills, and images stored in buffers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "gpu/tests/gpu_test_fixture.h"
#include "gpu/vulkan/image_readback.h"
#include "test_buffer_image.comp.h"

namespace limpid::gpu {
namespace {

using testing::HasSubstr;

size_t pixelsOf(Extent extent) {
    return size_t{extent.width} * extent.height;
}

std::vector<uint16_t> halfRamp(Extent extent) {
    std::vector<uint16_t> values;
    for (size_t i = 0; i < 4 * pixelsOf(extent); ++i)
        values.push_back(glm::packHalf1x16(static_cast<float>(i % 1000)));
    return values;
}

Dispatch doubling(ImageHandle source, ImageHandle result, ImageHandle copied, Extent extent) {
    return {.pass = "double",
            .shader = shaders::test_buffer_image_comp,
            .bindings = {{"source", source}, {"result", result}, {"copied", copied}},
            .extent = extent};
}

TEST_F(GpuTest, UploadsPixelsToImagesInEveryFrame) {
    FrameGraph graph;
    for (int frame = 0; frame < 3; ++frame) {
        graph.beginFrame();
        const ImageHandle small = graph.transient("small", Format::R32Uint, {3, 1});
        const ImageHandle a = graph.transient("a", rgba, odd);
        const ImageHandle b = graph.transient("b", rgba, odd);
        std::vector<float> pixels(4 * pixelsOf(odd));
        for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<float>(i) + 0.25f * frame;
        const std::vector<uint32_t> numbers{7, 8, 9};
        graph.upload(small, bytesOf(numbers));
        graph.upload(a, bytesOf(pixels));
        scale(graph, "scale", a, b, {{"bias", 0}});
        graph.execute(device());
        EXPECT_EQ(graph.downloadUint(device(), small), numbers);
        EXPECT_EQ(graph.downloadFloat(device(), a), pixels);
        const std::vector<float> scaled = graph.downloadFloat(device(), b);
        for (size_t i = 0; i < pixels.size(); ++i) ASSERT_EQ(scaled[i], 2 * pixels[i]) << i;
    }
}

TEST_F(GpuTest, ImagesInBuffersAreReadWrittenUploadedAndDownloaded) {
    FrameGraph graph;
    const std::vector<uint16_t> ramp = halfRamp(odd);
    graph.beginFrame();
    const auto inBuffer = [&](const char* name) {
        return graph.transient(name, Format::RGBA16Float, odd, Backing::Buffer);
    };
    const ImageHandle source = inBuffer("source"), once = inBuffer("once"), twice = inBuffer("twice");
    const ImageHandle image = graph.transient("image", rgba, odd);
    const ImageHandle last = graph.transient("last", rgba, odd);
    graph.upload(source, bytesOf(ramp));
    graph.dispatch(doubling(source, once, image, odd));
    graph.dispatch(doubling(once, twice, last, odd));
    ASSERT_EQ(graph.passes()[1].hazards.size(), 1u);
    EXPECT_EQ(graph.passes()[1].hazards[0].resource, "once");
    EXPECT_EQ(graph.passes()[0].imageBytes, pixelsOf(odd) * (8 + 8 + 16));
    graph.execute(device());
    const std::vector<float> values = graph.downloadFloat(device(), twice);
    const std::vector<float> copied = graph.downloadFloat(device(), last);
    for (size_t i = 0; i < ramp.size(); ++i) {
        ASSERT_EQ(values[i], 4 * glm::unpackHalf1x16(ramp[i])) << i;
        ASSERT_EQ(copied[i], values[i]) << i;
    }
}

TEST_F(GpuTest, AHostPassStandsBetweenThoseOfTheDevice) {
    FrameGraph graph;
    const std::vector<uint16_t> ramp = halfRamp(odd);
    for (int frame = 0; frame < 3; ++frame) {
        graph.beginFrame();
        const auto inBuffer = [&](const char* name) {
            return graph.transient(name, Format::RGBA16Float, odd, Backing::Buffer);
        };
        const ImageHandle source = inBuffer("source"), once = inBuffer("once"), shifted = inBuffer("shifted"),
                          twice = inBuffer("twice");
        const ImageHandle image = graph.transient("image", rgba, odd),
                          last = graph.transient("last", rgba, odd);
        graph.upload(source, bytesOf(ramp));
        graph.dispatch(doubling(source, once, image, odd));
        graph.host({.pass = "shift", .reads = {once}, .writes = {shifted}, .run = [](auto pixels) {
                        // Shift by one texel.
                        std::copy_n(pixels[0].begin() + 8, pixels[0].size() - 8, pixels[1].begin());
                        std::fill_n(pixels[1].end() - 8, 8, std::byte{0});
                    }});
        graph.dispatch(doubling(shifted, twice, last, odd));
        ASSERT_EQ(graph.passes()[1].hazards.size(), 1u);
        ASSERT_EQ(graph.passes()[2].hazards.size(), 1u);
        EXPECT_EQ(graph.passes()[2].hazards[0].earlierPass, "shift");
        EXPECT_EQ(graph.passes()[1].imageBytes, pixelsOf(odd) * 16);
        if (!device().isCpu()) {
            EXPECT_THAT(faultOf([&] { graph.execute(device()); }),
                        HasSubstr("pass 'shift': the host cannot see"));
            return;
        }
        graph.execute(device());
        const std::vector<float> values = graph.downloadFloat(device(), twice);
        for (size_t i = 0; i < values.size(); ++i)
            ASSERT_EQ(values[i], i + 4 < ramp.size() ? 4 * glm::unpackHalf1x16(ramp[i + 4]) : 0.0f) << i;
        EXPECT_EQ(graph.passTimes(device()).size(), 3u);
    }
}

/// Each frame overwrites what the one before it computed.
TEST_F(GpuTest, ReadbacksKeepWhatTheirFrameHas) {
    const auto floats = [](std::span<const std::byte> bytes) {
        std::vector<float> values(bytes.size() / sizeof(float));
        std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    };
    for (const Backing backing : {Backing::Image, Backing::Buffer}) {
        FrameGraph graph;
        std::vector<ImageReadback> readbacks;
        std::vector<std::vector<float>> expected;
        for (int frame = 0; frame < 4; ++frame) {
            graph.beginFrame();
            const ImageHandle image = graph.transient("image", rgba, odd, backing);
            expected.emplace_back(4 * pixelsOf(odd), static_cast<float>(frame));
            graph.upload(image, bytesOf(expected.back()));
            graph.execute(device());
            readbacks.emplace_back(device()).start(graph, image);
        }
        for (size_t i = 0; i < readbacks.size(); ++i)
            EXPECT_EQ(floats(readbacks[i].pixels()), expected[i]) << "of frame " << i;
    }
}

TEST_F(GpuTest, AReadbackIsUsedAgainForOtherSizes) {
    ImageReadback readback(device());
    EXPECT_TRUE(readback.pixels().empty());
    for (const Extent extent : {Extent{4, 3}, odd, Extent{2, 2}}) {
        FrameGraph graph;
        graph.beginFrame();
        const ImageHandle image = graph.transient("image", Format::R32Uint, extent);
        const std::vector<uint32_t> numbers(pixelsOf(extent), extent.width);
        graph.upload(image, bytesOf(numbers));
        EXPECT_THAT(faultOf([&] { readback.start(graph, image); }), HasSubstr("has not been executed"));
        graph.execute(device());
        readback.start(graph, image);
        const auto pixels = readback.pixels();
        ASSERT_EQ(pixels.size(), 4 * numbers.size());
        EXPECT_EQ(std::memcmp(pixels.data(), numbers.data(), pixels.size()), 0);
    }
}

TEST(FrameGraphImages, AHostPassTakesWrittenBuffersOnly) {
    FrameGraph graph;
    graph.beginFrame();
    const ImageHandle image = graph.transient("image", rgba, odd);
    const ImageHandle buffer = graph.transient("buffer", Format::RGBA16Float, odd, Backing::Buffer);
    const auto nothing = [](auto) {};
    EXPECT_THAT(faultOf([&] {
                    graph.host({"pass", {}, {image}, nothing});
                }),
                HasSubstr("'image', which is not in a buffer"));
    EXPECT_THAT(faultOf([&] {
                    graph.host({"pass", {buffer}, {}, nothing});
                }),
                HasSubstr("nothing has written image 'buffer'"));
    graph.host({"pass", {}, {buffer}, nothing});
    graph.host({"next", {buffer}, {}, nothing});
    EXPECT_EQ(graph.passes()[1].hazards.size(), 1u);
}

TEST(FrameGraphImages, AWrongUploadOrBackingIsRefusedByName) {
    FrameGraph graph;
    graph.beginFrame();
    const ImageHandle image = graph.transient("image", rgba, odd);
    const ImageHandle half = graph.transient("half", Format::RGBA16Float, odd);
    const ImageHandle buffer = graph.transient("buffer", Format::RGBA16Float, odd, Backing::Buffer);
    const std::vector<float> pixels(4 * pixelsOf(odd));
    const std::vector<float> few(7);
    EXPECT_THAT(faultOf([&] { graph.upload(image, bytesOf(few)); }),
                HasSubstr("image 'image' has 4368 bytes, but 28 are uploaded"));
    EXPECT_THAT(faultOf([&] {
                    const History history = graph.history("h", rgba, odd);
                    graph.upload(history.current, bytesOf(pixels));
                }),
                HasSubstr("'h' cannot be uploaded"));
    graph.upload(image, bytesOf(pixels));
    EXPECT_THAT(faultOf([&] { graph.upload(image, bytesOf(pixels)); }), HasSubstr("cannot be uploaded"));
    const ImageHandle out = graph.transient("out", Format::RGBA16Float, odd, Backing::Buffer);
    const ImageHandle copied = graph.transient("copied", rgba, odd);
    EXPECT_THAT(faultOf([&] { graph.dispatch(doubling(half, out, copied, odd)); }),
                HasSubstr("'source': is a storage buffer in the shader, but an image is bound"));
    graph.upload(buffer, bytesOf(halfRamp(odd)));
    EXPECT_THAT(faultOf([&] { graph.dispatch(doubling(buffer, out, buffer, odd)); }),
                HasSubstr("'copied': is an image in the shader, but what is bound lies in a buffer"));
    graph.dispatch(doubling(buffer, out, copied, odd));
}

}  // namespace
}  // namespace limpid::gpu
