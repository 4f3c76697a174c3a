// Tests buffers, limits and the lifetime of a device.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>

#include "gpu/tests/gpu_test_fixture.h"
#include "test_buffers.comp.h"

namespace limpid::gpu {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;

TEST_F(GpuTest, ReadsAndWritesBuffers) {
    const uint32_t count = 1000;
    std::vector<float> texels(4 * count), offsets(count);
    std::vector<uint32_t> indices(count);
    std::iota(texels.begin(), texels.end(), 0.0f);
    for (uint32_t i = 0; i < count; ++i) {
        indices[i] = count - 1 - i;
        offsets[i] = 0.5f;
    }
    const Buffer texelBuffer = device().createTexelBuffer("texels", rgba, bytesOf(texels));
    const Buffer indexBuffer = device().createTexelBuffer("indices", Format::R32Uint, bytesOf(indices));
    const Buffer offsetBuffer = device().createStorageBuffer("offsets", bytesOf(offsets));
    const Buffer counter = device().createStorageBuffer("counter", sizeof(uint32_t));
    const Buffer sums = device().createStorageBuffer("sums", count * sizeof(float));
    EXPECT_EQ(texelBuffer.size(), count * 16);
    EXPECT_EQ(texelBuffer.texelFormat(), rgba);
    EXPECT_FALSE(sums.texelFormat());
    FrameGraph graph;
    graph.beginFrame();
    for (int i = 0; i < 2; ++i) {
        graph.dispatch({.pass = "sum",
                        .shader = shaders::test_buffers_comp,
                        .bindings = {{"texels", &texelBuffer},
                                     {"indices", &indexBuffer},
                                     {"offsets", &offsetBuffer},
                                     {"counter", &counter},
                                     {"Sums", &sums}},
                        .extent = {count, 1}});
    }
    graph.execute(device());
    uint32_t counted = 0;
    std::memcpy(&counted, device().download(counter).data(), sizeof counted);
    EXPECT_EQ(counted, 2 * count);
    std::vector<float> result(count);
    const std::vector<std::byte> bytes = device().download(sums);
    ASSERT_EQ(bytes.size(), count * sizeof(float));
    std::memcpy(result.data(), bytes.data(), bytes.size());
    for (uint32_t i = 0; i < count; ++i) {
        ASSERT_EQ(result[i], 16.0f * static_cast<float>(indices[i]) + 6.5f) << i;
    }
    EXPECT_EQ(device().download(texelBuffer),
              std::vector<std::byte>(bytesOf(texels).begin(), bytesOf(texels).end()));
}

TEST_F(GpuTest, ABufferMayBeDestroyedWhileItsFrameIsUnderWay) {
    FrameGraph graph;
    for (int frame = 0; frame < 4; ++frame) {
        graph.beginFrame();
        const Buffer texels = device().createTexelBuffer("texels", rgba, {});
        const Buffer indices = device().createTexelBuffer("indices", Format::R32Uint, {});
        const Buffer offsets = device().createStorageBuffer("offsets", 400),
                     sums = device().createStorageBuffer("sums", 400);
        const Buffer counter = device().createStorageBuffer("counter", 4);
        graph.dispatch({.pass = "sum",
                        .shader = shaders::test_buffers_comp,
                        .bindings = {{"texels", &texels},
                                     {"indices", &indices},
                                     {"offsets", &offsets},
                                     {"counter", &counter},
                                     {"Sums", &sums}},
                        .extent = {100, 1}});
        if (frame % 2) graph.execute(device());
    }
}

TEST_F(GpuTest, UploadsPrecedeThePassesOfTheirFrameAndFollowThoseBefore) {
    const std::vector<uint32_t> zeros(64, 0u);
    const Buffer buffer = device().createStorageBuffer("target", bytesOf(zeros));
    FrameGraph graph;
    for (uint32_t frame = 1; frame <= 3; ++frame) {
        graph.beginFrame();
        const std::vector<uint32_t> low(2, frame), high(1, 10 * frame);
        graph.upload(buffer, 0, bytesOf(low));
        graph.upload(buffer, 252, bytesOf(high));
        graph.execute(device());
    }
    const std::vector<std::byte> bytes = device().download(buffer);
    std::vector<uint32_t> values(64);
    std::memcpy(values.data(), bytes.data(), bytes.size());
    EXPECT_EQ(values[0], 3u);
    EXPECT_EQ(values[1], 3u);
    EXPECT_EQ(values[2], 0u);
    EXPECT_EQ(values[63], 30u);
    graph.beginFrame();
    EXPECT_THROW(graph.upload(buffer, 252, bytesOf(std::vector<uint32_t>(2))), Error);
    EXPECT_THROW(graph.upload(buffer, 2, bytesOf(std::vector<uint32_t>(1))), Error);
}

TEST_F(GpuTest, EmptyDataGivesOneZeroTexel) {
    const Buffer buffer = device().createTexelBuffer("none", rgba, {});
    EXPECT_EQ(device().download(buffer), std::vector<std::byte>(16));
    EXPECT_THAT(faultOf([&] { device().createTexelBuffer("ragged", rgba, std::vector<std::byte>(15)); }),
                AllOf(HasSubstr("'ragged'"), HasSubstr("no whole number")));
}

TEST_F(GpuTest, BuffersBeyondALimitAreRefusedByName) {
    const uint64_t elements = device().maxTexelBufferElements() + 1;
    const uint64_t bytes = elements * 4;
    // Reserves only address space: the size must be rejected before the data is read.
    void* space = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    ASSERT_NE(space, MAP_FAILED);
    const std::span<const std::byte> data(static_cast<const std::byte*>(space), bytes);
    EXPECT_THAT(faultOf([&] { device().createTexelBuffer("all texels", Format::R32Uint, data); }),
                AllOf(HasSubstr("'all texels'"),
                      HasSubstr("maxTexelBufferElements = " + std::to_string(elements - 1)),
                      HasSubstr(std::to_string(elements) + " texels")));
    ::munmap(space, bytes);
    const uint64_t range = device().impl().context->limits().maxStorageBufferRange;
    EXPECT_THAT(faultOf([&] { device().createStorageBuffer("heap", range + 1); }),
                AllOf(HasSubstr("'heap'"), HasSubstr("maxStorageBufferRange = " + std::to_string(range))));
    EXPECT_THAT(faultOf([&] {
                    makeBuffer(device().impl().context, "big", BufferUse::Staging,
                               device().maxBufferBytes() + 1);
                }),
                AllOf(HasSubstr("'big'"), HasSubstr(std::to_string(device().maxBufferBytes()))));
}

TEST_F(GpuTest, LargeUploadsGoThroughBoundedStaging) {
    std::vector<uint32_t> data((uint64_t{80} << 20) / 4);  // more than one chunk
    std::iota(data.begin(), data.end(), 7u);
    const Buffer buffer = device().createTexelBuffer("large", Format::R32Uint, bytesOf(data));
    const std::vector<std::byte> bytes = device().download(buffer);
    ASSERT_EQ(bytes.size(), data.size() * 4);
    EXPECT_EQ(std::memcmp(bytes.data(), data.data(), bytes.size()), 0);
}

TEST_F(GpuTest, BorrowedUploadsGoThroughBoundedStaging) {
    constexpr Extent extent{1400, 1000};  // 21 MB each, four of them more than is staged together
    std::vector<std::vector<float>> pictures(4);
    for (std::vector<float>& picture : pictures) {
        picture.resize(size_t{4} * extent.width * extent.height);
        std::iota(picture.begin(), picture.end(), 1e6f * static_cast<float>(&picture - pictures.data()));
    }
    FrameGraph graph({.framesInFlight = 1});
    for (int frame = 0; frame < 2; ++frame) {
        graph.beginFrame();
        std::vector<ImageHandle> images;
        for (const std::vector<float>& picture : pictures) {
            const std::string name = "picture " + std::to_string(images.size());
            images.push_back(graph.transient(name, rgba, extent));
            if (images.size() == 2)
                graph.upload(images.back(), bytesOf(picture));
            else
                graph.uploadBorrowed(images.back(), bytesOf(picture));
        }
        const uint64_t before = device().allocatedBytes();
        graph.execute(device());
        const uint64_t all = 4 * bytesOf(pictures[0]).size();
        EXPECT_LT(device().allocatedBytes() - before, all + (uint64_t{70} << 20));
        for (size_t i = 0; i < images.size(); ++i)
            EXPECT_TRUE(graph.downloadFloat(device(), images[i]) == pictures[i]) << i;
        for (std::vector<float>& picture : pictures) std::reverse(picture.begin(), picture.end());
    }
}

TEST_F(GpuTest, StagedCopiesWorkWhereMemoryCouldBeMapped) {
    // On lavapipe every buffer is mapped. Hide that to test the path of discrete GPUs too.
    std::vector<uint32_t> data((uint64_t{65} << 20) / 4);
    std::iota(data.begin(), data.end(), 1u);
    auto storage =
        makeBuffer(device().impl().context, "staged", BufferUse::Texel, data.size() * 4, Format::R32Uint);
    storage->memory.mapped = nullptr;
    Transfer& transfer = device().impl().transfer();
    transfer.upload(*storage, bytesOf(data));
    std::vector<std::byte> bytes(data.size() * 4);
    transfer.download(*storage, bytes);
    EXPECT_EQ(std::memcmp(bytes.data(), data.data(), bytes.size()), 0);
    transfer.zero(*storage);
    transfer.download(*storage, bytes);
    EXPECT_THAT(std::span(bytes).first(1000), Each(std::byte{0}));
}

TEST_F(GpuTest, NothingOutlivesTheDeviceWrongly) {
    FrameGraph graph;
    Buffer buffer;
    {
        Device other({.select = wantedDevice(), .validation = validated_});
        buffer = other.createStorageBuffer("buffer", 4);
        graph.beginFrame();
        fill(graph, "fill", graph.transient("a", rgba, odd));
        graph.execute(other);
    }
}

TEST_F(GpuTest, DeviceInfoIsComplete) {
    const DeviceInfo& info = device().info();
    EXPECT_TRUE(info.usable);
    EXPECT_TRUE(info.whyNot.empty());
    EXPECT_FALSE(info.name.empty());
    EXPECT_FALSE(info.driver.empty());
    EXPECT_GT(info.memoryBytes, 0u);
    const auto has = [&](const char* name) {
        return std::ranges::any_of(info.features, [&](const auto& f) { return f.first == name; });
    };
    for (const char* name : {"synchronization2", "scalarBlockLayout", "shaderFloat16", "shaderInt64",
                             "VK_KHR_acceleration_structure", "VK_KHR_ray_tracing_pipeline",
                             "VK_KHR_ray_query", "VK_KHR_cooperative_matrix", "VK_EXT_debug_utils"}) {
        EXPECT_TRUE(has(name)) << name;
    }
    for (const auto& [name, value] : info.limits) EXPECT_GT(value, 0u) << name;
}

}  // namespace
}  // namespace limpid::gpu
