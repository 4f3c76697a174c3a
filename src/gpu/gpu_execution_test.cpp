// Whole frames on a device, with validation and synchronisation validation where the layer is installed.
// LIMPID_TEST_DEVICE selects the device as --device does; default: cpu (lavapipe).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include <bit>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <numeric>

#include "base/error.h"
#include "base/log.h"
#include "gpu/check.h"
#include "gpu/dispatch_recorder.h"
#include "gpu/format.h"
#include "gpu/frame_executor.h"
#include "gpu/frame_graph.h"
#include "test_accumulate.comp.h"
#include "test_buffers.comp.h"
#include "test_fill.comp.h"
#include "test_formats.comp.h"
#include "test_group_size.comp.h"
#include "test_increment.comp.h"
#include "test_scale.comp.h"
#include "test_unused.comp.h"

namespace limpid::gpu {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;

constexpr Extent odd{21, 13};
constexpr Format rgba = Format::RGBA32Float;

std::string faultOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

std::string wantedDevice() {
    const char* variable = std::getenv("LIMPID_TEST_DEVICE");
    return variable ? variable : "cpu";
}

struct FillParams {
    float color[3] = {1, 2, 3};
    float step = 1;
    float tail[3] = {};
};

class GpuTest : public testing::Test {
  protected:
    void SetUp() override {
        if (enumerateDevices().empty()) {
            GTEST_SKIP()
                << "NOT TESTED: this machine has no Vulkan device. Install mesa-vulkan-drivers (lavapipe).";
        }
        try {
            device_ = std::make_unique<Device>(DeviceOptions{.select = wantedDevice(), .validation = true});
            validated_ = true;
        } catch (const Error& error) {
            if (std::string(error.what()).find("vulkan-validationlayers") == std::string::npos) throw;
            log::warn("NOT VALIDATED: {}", error.what());
            device_ = std::make_unique<Device>(DeviceOptions{.select = wantedDevice()});
        }
    }
    void TearDown() override {
        if (device_ && expectNoMessages_) {
            EXPECT_EQ(device().validationMessages(), 0u);
        }
    }

    Device& device() { return *device_; }
    static void fill(FrameGraph& graph, std::string_view pass, ImageHandle image,
                     const FillParams& params = {}) {
        graph.dispatch({.pass = pass,
                        .shader = shaders::test_fill_comp,
                        .bindings = {{"result", image}},
                        .params = paramsOf(params),
                        .extent = graph.extent(image)});
    }
    static void scale(FrameGraph& graph, std::string_view pass, ImageHandle source, ImageHandle result,
                      std::vector<ConstantValue> constants = {}) {
        graph.dispatch({.pass = pass,
                        .shader = shaders::test_scale_comp,
                        .bindings = {{"source", source}, {"result", result}},
                        .constants = std::move(constants),
                        .extent = graph.extent(result)});
    }
    static History accumulate(FrameGraph& graph, Extent extent) {
        const History history = graph.history("count", Format::R32Float, extent);
        const uint32_t valid = history.valid;
        graph.dispatch({.pass = "accumulate",
                        .shader = shaders::test_accumulate_comp,
                        .bindings = {{"previous", history.previous}, {"current", history.current}},
                        .params = paramsOf(valid),
                        .extent = extent});
        return history;
    }

    std::unique_ptr<Device> device_;
    bool validated_ = false;
    bool expectNoMessages_ = true;
};

TEST_F(GpuTest, ChainsPassesWithParamsAndConstants) {
    FrameGraph graph;
    graph.beginFrame();
    const ImageHandle a = graph.transient("a", rgba, odd);
    const ImageHandle b = graph.transient("b", rgba, odd);
    const ImageHandle c = graph.transient("c", rgba, odd);
    FillParams params{.step = 0.5f, .tail = {10, 20, 30}};
    fill(graph, "fill", a, params);
    params.step = 99;  // params are copied at once
    scale(graph, "default", a, b);
    scale(graph, "constants", b, c,
          {{"bias", static_cast<uint32_t>(-4)}, {"negate", 1}, {"factor", std::bit_cast<uint32_t>(0.25f)}});
    graph.execute(device());
    const std::vector<float> first = graph.downloadFloat(device(), b);
    const std::vector<float> last = graph.downloadFloat(device(), c);
    ASSERT_EQ(last.size(), size_t{odd.width} * odd.height * 4);
    for (uint32_t y = 0; y < odd.height; ++y) {
        for (uint32_t x = 0; x < odd.width; ++x) {
            const float expected[] = {11, 22, 33, 0.5f * static_cast<float>(x + 100 * y)};
            for (uint32_t i = 0; i < 4; ++i) {
                const size_t at = (size_t{y} * odd.width + x) * 4 + i;
                ASSERT_EQ(first[at], 2 * expected[i]) << x << ' ' << y;
                ASSERT_EQ(last[at], -(0.5f * expected[i] - 4)) << x << ' ' << y;
            }
        }
    }
}

TEST_F(GpuTest, ReadsAndWritesOneImage) {
    FrameGraph graph;
    graph.beginFrame();
    const ImageHandle a = graph.transient("a", rgba, odd);
    fill(graph, "fill", a);
    for (int i = 0; i < 5; ++i) {
        graph.dispatch({.pass = "increment",
                        .shader = shaders::test_increment_comp,
                        .bindings = {{"value", a}},
                        .extent = odd});
    }
    graph.execute(device());
    EXPECT_EQ(graph.downloadFloat(device(), a)[0], 6.0f);
}

TEST_F(GpuTest, HistoriesLiveAcrossFrames) {
    FrameGraph graph;
    for (int frame = 1; frame <= 7; ++frame) {
        graph.beginFrame();
        const History history = accumulate(graph, odd);
        EXPECT_EQ(history.valid, frame > 1);
        graph.execute(device());
        if (frame % 3 != 0) continue;  // the others overlap
        EXPECT_THAT(graph.downloadFloat(device(), history.current), Each(static_cast<float>(frame)));
        EXPECT_THAT(graph.downloadFloat(device(), history.previous), Each(static_cast<float>(frame - 1)));
    }
}

TEST_F(GpuTest, HistoriesStartAnewFromZeroAfterResetAndResize) {
    FrameGraph graph;
    const auto frame = [&](Extent extent) {
        graph.beginFrame();
        const History history = accumulate(graph, extent);
        graph.execute(device());
        return graph.downloadFloat(device(), history.current);
    };
    frame(odd);
    EXPECT_THAT(frame(odd), Each(2.0f));
    EXPECT_THAT(frame({5, 40}), Each(1.0f));
    EXPECT_THAT(frame({5, 40}), Each(2.0f));
    EXPECT_THAT(frame(odd), Each(1.0f)) << "the first pair is still in the pool, and must be zeroed again";
    EXPECT_THAT(frame(odd), Each(2.0f));
    graph.resetHistories();
    EXPECT_THAT(frame(odd), Each(1.0f));
    EXPECT_THAT(frame(odd), Each(2.0f));
    EXPECT_THAT(frame({1, 1}), Each(1.0f));
}

TEST_F(GpuTest, AFrameThatIsNotExecutedLeavesHistoriesAlone) {
    FrameGraph graph;
    graph.beginFrame();
    accumulate(graph, odd);
    graph.execute(device());
    graph.beginFrame();
    accumulate(graph, odd);
    graph.beginFrame();
    const History history = accumulate(graph, odd);
    graph.execute(device());
    EXPECT_THAT(graph.downloadFloat(device(), history.current), Each(2.0f));
}

TEST_F(GpuTest, UnusedImagesAreFreed) {
    FrameGraph::Impl graph;
    FrameExecutor executor(device().impl().context);
    for (uint32_t size = 1; size <= 40; ++size) {
        RecordedFrame frame;
        frame.images.push_back({.name = "a", .key = {"a", 0, rgba, size, size}});
        executor.execute(frame);
        EXPECT_LE(executor.pooledImages(), 10u);
    }
}

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

TEST_F(GpuTest, EmptyDataGivesOneZeroTexel) {
    const Buffer buffer = device().createTexelBuffer("none", rgba, {});
    EXPECT_EQ(device().download(buffer), std::vector<std::byte>(16));
    EXPECT_THAT(faultOf([&] { device().createTexelBuffer("ragged", rgba, std::vector<std::byte>(15)); }),
                AllOf(HasSubstr("'ragged'"), HasSubstr("no whole number")));
}

TEST_F(GpuTest, BuffersBeyondALimitAreRefusedByName) {
    const uint64_t elements = device().maxTexelBufferElements() + 1;
    const uint64_t bytes = elements * 4;
    // Address space only: the refusal must come before the data is read.
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

TEST_F(GpuTest, StagedCopiesWorkWhereMemoryCouldBeMapped) {
    // On lavapipe every buffer is mapped; hide that, so that the path of discrete GPUs runs here too.
    std::vector<uint32_t> data((uint64_t{65} << 20) / 4);
    std::iota(data.begin(), data.end(), 1u);
    auto storage =
        makeBuffer(device().impl().context, "staged", BufferUse::Texel, data.size() * 4, Format::R32Uint);
    storage->memory.mapped = nullptr;
    Transfer& transfer = device().impl().transfer;
    transfer.upload(*storage, bytesOf(data));
    std::vector<std::byte> bytes(data.size() * 4);
    transfer.download(*storage, bytes);
    EXPECT_EQ(std::memcmp(bytes.data(), data.data(), bytes.size()), 0);
    transfer.zero(*storage);
    transfer.download(*storage, bytes);
    EXPECT_THAT(std::span(bytes).first(1000), Each(std::byte{0}));
}

TEST_F(GpuTest, DownloadsEveryFormat) {
    FrameGraph graph;
    graph.beginFrame();
    constexpr const char* names[] = {"r32Float",    "r32Uint",    "rg32Float",   "rg32Uint",
                                     "rgba32Float", "rgba32Uint", "rgba16Float", "rgba8Unorm"};
    std::vector<Binding> bindings;
    std::vector<ImageHandle> images;
    for (size_t i = 0; i < 8; ++i) {
        images.push_back(graph.transient(names[i], allFormats()[i], odd));
        bindings.push_back({names[i], images.back()});
    }
    graph.dispatch(
        {.pass = "formats", .shader = shaders::test_formats_comp, .bindings = bindings, .extent = odd});
    graph.execute(device());
    for (size_t i = 0; i < 8; ++i) {
        const Format format = allFormats()[i];
        const uint32_t components = componentCount(format);
        const bool isUint = toString(format).find("Uint") != std::string_view::npos;
        const size_t at = (size_t{3} * odd.width + 20) * components;  // pixel (20, 3)
        if (isUint) {
            const std::vector<uint32_t> values = graph.downloadUint(device(), images[i]);
            const uint32_t expected[] = {20, 3, 4000000000u, 7};
            ASSERT_EQ(values.size(), size_t{odd.width} * odd.height * components);
            for (uint32_t c = 0; c < components; ++c)
                EXPECT_EQ(values[at + c], expected[c]) << toString(format);
            EXPECT_THAT(faultOf([&] { graph.downloadFloat(device(), images[i]); }),
                        HasSubstr("use downloadUint"));
        } else {
            const std::vector<float> values = graph.downloadFloat(device(), images[i]);
            const bool unorm = format == Format::RGBA8Unorm;
            const float expected[] = {unorm ? 20.0f / 255.0f : 20.0f, unorm ? 1.0f : 3.0f,
                                      unorm ? 0.0f : 0.25f, unorm ? 1.0f : -1.5f};
            ASSERT_EQ(values.size(), size_t{odd.width} * odd.height * components);
            for (uint32_t c = 0; c < components; ++c)
                EXPECT_EQ(values[at + c], expected[c]) << toString(format);
            EXPECT_THAT(faultOf([&] { graph.downloadUint(device(), images[i]); }),
                        HasSubstr("use downloadFloat"));
        }
    }
}

TEST_F(GpuTest, ConstantsSetTheWorkgroupSize) {
    FrameGraph graph;
    for (const uint32_t width : {8u, 16u}) {
        graph.beginFrame();
        const ImageHandle image = graph.transient("size", Format::RG32Uint, odd);
        graph.dispatch({.pass = "size",
                        .shader = shaders::test_group_size_comp,
                        .bindings = {{"result", image}},
                        .constants = {{"groupWidth", width}, {"groupHeight", 2}},
                        .extent = odd});
        graph.execute(device());
        const std::vector<uint32_t> values = graph.downloadUint(device(), image);
        for (size_t i = 0; i < values.size(); i += 2) {
            ASSERT_EQ(values[i], width);
            ASSERT_EQ(values[i + 1], 2u);
        }
    }
    graph.beginFrame();
    const ImageHandle image = graph.transient("size", Format::RG32Uint, odd);
    graph.dispatch({.pass = "size",
                    .shader = shaders::test_group_size_comp,
                    .bindings = {{"result", image}},
                    .constants = {{"groupWidth", 1u << 20}},
                    .extent = odd});
    EXPECT_THAT(faultOf([&] { graph.execute(device()); }),
                AllOf(HasSubstr("test_group_size.comp"), HasSubstr("maxComputeWorkGroupSize")));
}

TEST_F(GpuTest, AFailedFrameDoesNotHarmTheNext) {
    FrameGraph graph;
    graph.beginFrame();
    accumulate(graph, odd);
    const ImageHandle image = graph.transient("size", Format::RG32Uint, odd);
    graph.dispatch({.pass = "size",
                    .shader = shaders::test_group_size_comp,
                    .bindings = {{"result", image}},
                    .constants = {{"groupWidth", 1u << 20}},
                    .extent = odd});
    EXPECT_THROW(graph.execute(device()), Error);
    for (int frame = 1; frame <= 3; ++frame) {
        graph.beginFrame();
        const History history = accumulate(graph, odd);
        graph.execute(device());
        EXPECT_THAT(graph.downloadFloat(device(), history.current), Each(static_cast<float>(frame)));
    }
}

TEST_F(GpuTest, UnusedVariablesAreBoundWithoutComplaint) {
    FrameGraph graph;
    graph.beginFrame();
    const ImageHandle a = graph.transient("a", rgba, odd), b = graph.transient("b", rgba, odd);
    fill(graph, "fill", a);
    graph.dispatch({.pass = "unused",
                    .shader = shaders::test_unused_comp,
                    .bindings = {{"result", b}, {"unused", a}},
                    .extent = odd});
    graph.execute(device());
    EXPECT_THAT(graph.downloadFloat(device(), b), Each(1.0f));
}

TEST_F(GpuTest, TimesEveryPassOfTheLastFrame) {
    FrameGraph graph;
    EXPECT_TRUE(graph.passTimes(device()).empty());
    for (int frame = 0; frame < 3; ++frame) {
        graph.beginFrame();
        const ImageHandle a = graph.transient("a", rgba, {256, 256}),
                          b = graph.transient("b", rgba, {256, 256});
        fill(graph, "fill", a);
        scale(graph, "scale", a, b);
        graph.execute(device());
    }
    const std::vector<PassTime> times = graph.passTimes(device());
    ASSERT_EQ(times.size(), 2u);
    EXPECT_EQ(times[0].name, "fill");
    EXPECT_EQ(times[1].name, "scale");
    for (const PassTime& time : times) {
        EXPECT_GE(time.milliseconds, 0.0);
        RecordProperty(time.name, std::to_string(time.milliseconds));
    }
}

TEST_F(GpuTest, ManyPassesGrowPoolsAndRings) {
    FrameGraph graph;
    for (int frame = 0; frame < 4; ++frame) {
        graph.beginFrame();
        const ImageHandle a = graph.transient("a", rgba, {4, 4});
        const int passes = frame % 2 ? 400 : 3;
        for (int i = 0; i < passes; ++i) {
            fill(graph, "fill " + std::to_string(i), a, {.color = {static_cast<float>(i), 0, 0}});
        }
        graph.execute(device());
        EXPECT_EQ(graph.downloadFloat(device(), a)[0], static_cast<float>(passes - 1));
        EXPECT_EQ(graph.passTimes(device()).size(), static_cast<size_t>(passes));
    }
}

TEST_F(GpuTest, MisuseIsAnError) {
    FrameGraph graph;
    graph.beginFrame();
    const ImageHandle a = graph.transient("a", rgba, odd),
                      unwritten = graph.transient("unwritten", rgba, odd);
    fill(graph, "fill", a);
    EXPECT_THAT(faultOf([&] { graph.downloadFloat(device(), a); }), HasSubstr("has not been executed"));
    graph.execute(device());
    EXPECT_THAT(faultOf([&] { graph.execute(device()); }), HasSubstr("has been executed"));
    EXPECT_THAT(faultOf([&] { graph.downloadFloat(device(), unwritten); }), HasSubstr("no pass wrote it"));
    Device other({.select = wantedDevice()});
    EXPECT_THAT(faultOf([&] { graph.downloadFloat(other, a); }), HasSubstr("another device"));
    EXPECT_THAT(faultOf([&] { graph.passTimes(other); }), HasSubstr("another device"));
    graph.beginFrame();
    EXPECT_THAT(faultOf([&] { graph.downloadFloat(device(), a); }), HasSubstr("earlier frame"));
    EXPECT_THAT(faultOf([&] { graph.execute(other); }), HasSubstr("this is another"));
    const Buffer foreign = other.createStorageBuffer("foreign", 4);
    EXPECT_THAT(faultOf([&] { device().download(foreign); }),
                HasSubstr("'foreign' belongs to another device"));
    const uint32_t tooLarge = device().impl().context->limits().maxImageDimension2D + 1;
    graph.transient("wide", rgba, {tooLarge, 1});
    EXPECT_THAT(faultOf([&] { graph.execute(device()); }),
                AllOf(HasSubstr("'wide'"), HasSubstr("maxImageDimension2D")));
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

TEST_F(GpuTest, ValidationSeesAMissingBarrier) {
    if (!validated_)
        GTEST_SKIP() << "NOT TESTED: the validation layer is not installed (vulkan-validationlayers).";
    expectNoMessages_ = false;
    // The same frame twice: as recorded, and with the hazards that make its barriers taken away.
    for (const bool barriers : {true, false}) {
        FrameGraph::Impl graph;
        graph.frame.number = 1;
        const ImageHandle a = graph.addImage({.name = "a", .key = {"a", 0, rgba, 64, 64}});
        const ImageHandle b = graph.addImage({.name = "b", .key = {"b", 0, rgba, 64, 64}});
        const FillParams params;
        DispatchRecorder(graph, {.pass = "fill",
                                 .shader = shaders::test_fill_comp,
                                 .bindings = {{"result", a}},
                                 .params = paramsOf(params),
                                 .extent = {64, 64}})
            .record();
        DispatchRecorder(graph, {.pass = "scale",
                                 .shader = shaders::test_scale_comp,
                                 .bindings = {{"source", a}, {"result", b}},
                                 .extent = {64, 64}})
            .record();
        ASSERT_EQ(graph.frame.passes[1].hazards.size(), 1u);
        if (!barriers) graph.frame.passes[1].hazards.clear();
        FrameExecutor executor(device().impl().context);
        executor.execute(graph.frame);
        if (barriers) {
            EXPECT_EQ(device().validationMessages(), 0u);
        } else {
            EXPECT_GT(device().validationMessages(), 0u);
        }
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

DeviceInfo described(uint32_t index, const char* name, const char* type, bool usable = true) {
    DeviceInfo info;
    info.index = index;
    info.name = name;
    info.type = type;
    info.usable = usable;
    if (!usable) info.whyNot = "scalarBlockLayout";
    return info;
}

TEST(DeviceChoice, FollowsTheRules) {
    const std::vector<DeviceInfo> infos{
        described(0, "llvmpipe (LLVM 15)", "cpu"), described(1, "Old GPU", "discrete", false),
        described(2, "Intel UHD", "integrated"), described(3, "NVIDIA H200", "discrete"),
        described(4, "NVIDIA H200", "discrete")};
    EXPECT_EQ(chooseIndex(infos, ""), 3u);
    EXPECT_EQ(chooseIndex(infos, "cpu"), 0u);
    EXPECT_EQ(chooseIndex(infos, "CPU"), 0u);
    EXPECT_EQ(chooseIndex(infos, "2"), 2u);
    EXPECT_EQ(chooseIndex(infos, "h200"), 3u);
    EXPECT_EQ(chooseIndex(infos, "LLVM"), 0u);
    EXPECT_THAT(faultOf([&] { chooseIndex(infos, "1"); }),
                AllOf(HasSubstr("no usable Vulkan device is '1'"),
                      HasSubstr("unusable: it lacks scalarBlockLayout")));
    EXPECT_THAT(
        faultOf([&] { chooseIndex(infos, "radeon"); }),
        AllOf(HasSubstr("no Vulkan device matches 'radeon'"), HasSubstr("3: NVIDIA H200 (discrete)")));
    EXPECT_THAT(faultOf([&] { chooseIndex(infos, "7"); }), HasSubstr("no Vulkan device matches '7'"));
    EXPECT_THAT(faultOf([&] { chooseIndex({infos[1]}, ""); }), HasSubstr("no Vulkan device here is usable"));
}

TEST(DeviceChoice, WithoutADriverThereAreNoDevicesAndTheErrorHelps) {
    // The loader reads these at each instance; one test is one process, or the last one.
    ::setenv("VK_ICD_FILENAMES", "/nonexistent/icd.json", 1);
    ::setenv("VK_DRIVER_FILES", "/nonexistent/icd.json", 1);
    EXPECT_TRUE(enumerateDevices().empty());
    EXPECT_THAT(faultOf([] { Device device; }), HasSubstr("mesa-vulkan-drivers"));
    ::unsetenv("VK_ICD_FILENAMES");
    ::unsetenv("VK_DRIVER_FILES");
}

TEST(Check, NamesTheCallThePlaceAndTheResult) {
    EXPECT_THAT(faultOf([] { LIMPID_VK(VK_ERROR_DEVICE_LOST); }),
                AllOf(HasSubstr("the device was lost"), HasSubstr("VK_ERROR_DEVICE_LOST"),
                      HasSubstr("(src/gpu/gpu_execution_test.cpp:")));
    EXPECT_THAT(faultOf([] { LIMPID_VK(VK_ERROR_OUT_OF_DEVICE_MEMORY); }), HasSubstr("out of device memory"));
    EXPECT_THAT(faultOf([] { LIMPID_VK(VK_ERROR_OUT_OF_HOST_MEMORY); }), HasSubstr("out of host memory"));
    EXPECT_EQ(faultOf([] { LIMPID_VK(VK_SUCCESS); }), "no error");
}

}  // namespace
}  // namespace limpid::gpu
