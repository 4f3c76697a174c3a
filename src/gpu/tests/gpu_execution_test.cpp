// Tests whole frames on a device.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <vector>

#include "gpu/graph/dispatch_recorder.h"
#include "gpu/tests/gpu_test_fixture.h"
#include "gpu/vulkan/execute/frame_executor.h"
#include "gpu/vulkan/memory/format.h"
#include "test_formats.comp.h"
#include "test_group_size.comp.h"
#include "test_increment.comp.h"
#include "test_unused.comp.h"

namespace limpid::gpu {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;

TEST_F(GpuTest, ChainsPassesWithParamsAndConstants) {
    FrameGraph graph;
    graph.beginFrame();
    const ImageHandle a = graph.transient("a", rgba, odd);
    const ImageHandle b = graph.transient("b", rgba, odd);
    const ImageHandle c = graph.transient("c", rgba, odd);
    FillParams params{.step = 0.5f, .tail = {10, 20, 30}};
    fill(graph, "fill", a, params);
    params.step = 99;  // params were copied immediately
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

/// Frames that are cut into short submissions: cheap passes together, and what has no known time yet alone.
TEST_F(GpuTest, InterruptibleFramesComputeTheSame) {
    constexpr Extent extent{700, 300};
    const auto run = [&](bool interruptible) {
        FrameGraph graph;
        int asked = 0;
        if (interruptible) graph.setInterruption([&] { return ++asked, false; });
        std::vector<float> pixels;
        for (int frame = 0; frame < 3; ++frame) {
            graph.beginFrame();
            const ImageHandle a = graph.transient("a", rgba, extent), b = graph.transient("b", rgba, extent);
            FillParams params{.step = 0.5f};
            fill(graph, "fill", a, params);
            scale(graph, "scale", a, b);
            const History history = accumulate(graph, extent);
            graph.execute(device());
            pixels = graph.downloadFloat(device(), b);
            const std::vector<float> counted = graph.downloadFloat(device(), history.current);
            pixels.insert(pixels.end(), counted.begin(), counted.end());
        }
        EXPECT_EQ(asked > 3, interruptible && this->device().isCpu());
        return pixels;
    };
    EXPECT_EQ(run(true), run(false));
}

TEST_F(GpuTest, AnInterruptedFrameEndsAtOnce) {
    if (!device().isCpu()) GTEST_SKIP() << "NOT TESTED: only frames on CPUs can be interrupted.";
    constexpr Extent extent{700, 300};
    int asked = 0;
    {
        FrameGraph graph;
        graph.setInterruption([&] { return ++asked == 3; });
        graph.beginFrame();
        const ImageHandle a = graph.transient("a", rgba, extent);
        fill(graph, "fill", a);
        for (int i = 0; i < 20; ++i)
            graph.dispatch({.pass = "increment",
                            .shader = shaders::test_increment_comp,
                            .bindings = {{"value", a}},
                            .extent = extent});
        EXPECT_THROW(graph.execute(device()), Interrupted);
    }
    EXPECT_EQ(asked, 3);
    FrameGraph graph;  // the device works as before
    graph.beginFrame();
    const ImageHandle a = graph.transient("a", rgba, odd);
    fill(graph, "fill", a);
    graph.execute(device());
    EXPECT_EQ(graph.downloadFloat(device(), a)[0], 1.0f);
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

TEST_F(GpuTest, HistoriesStartFromZeroAfterAWarmUp) {
    FrameGraph graph;
    const auto warmUp = [&] {
        graph.beginFrame();
        accumulate(graph, odd);
        device().impl().transfer().run(
            [&](VkCommandBuffer commands) { graph.clearImages(device(), commands); });
    };
    const auto frame = [&] {
        graph.beginFrame();
        const History history = accumulate(graph, odd);
        graph.execute(device());
        return graph.downloadFloat(device(), history.current);
    };
    warmUp();
    EXPECT_THAT(frame(), Each(1.0f));
    EXPECT_THAT(frame(), Each(2.0f));
    warmUp();
    EXPECT_THAT(frame(), Each(3.0f)) << "a later warm-up leaves histories alone";
    graph.resetHistories();
    EXPECT_THAT(frame(), Each(1.0f)) << "they hold frames, and must be zeroed again";
    EXPECT_THAT(frame(), Each(2.0f));
}

TEST_F(GpuTest, ImagesThatShareMemoryHoldWhatTheyWouldHoldAlone) {
    FrameGraph alone, shared({.shareMemory = true});
    const auto frame = [&](FrameGraph& graph) {
        graph.beginFrame();
        const History history = accumulate(graph, odd);
        const ImageHandle next = graph.transient("next", Format::R32Float, odd);  // takes the past's memory
        const uint32_t valid = 1;
        graph.dispatch({.pass = "next",
                        .shader = shaders::test_accumulate_comp,
                        .bindings = {{"previous", history.current}, {"current", next}},
                        .params = paramsOf(valid),
                        .extent = odd});
        ImageHandle image = graph.transient("first", rgba, odd);
        fill(graph, "fill", image);
        for (const char* name : {"second", "third", "fourth", "fifth"}) {  // in two images' memory
            const ImageHandle result = graph.transient(name, rgba, odd);
            scale(graph, name, image, result);
            image = result;
        }
        graph.execute(device());
        return std::pair(graph.downloadFloat(device(), next), graph.downloadFloat(device(), image));
    };
    for (int i = 0; i < 6; ++i) {
        const auto [next, image] = frame(shared);
        EXPECT_THAT(next, Each(static_cast<float>(i % 3 + 2)));
        EXPECT_EQ(image, frame(alone).second);
        if (i == 2) shared.resetHistories();  // what was in the past's memory must be zeroed again
    }
    const uint64_t pixels = uint64_t{odd.width} * odd.height;
    EXPECT_EQ(alone.imageBytes() - shared.imageBytes(), pixels * (4 + 3 * 16));
    EXPECT_EQ(shared.passes().back().hazards.size(), 2u)
        << "reads the fourth, and writes where the third was read";
}

TEST_F(GpuTest, AHistoryThatIsWrittenInPlaceKeepsItsPast) {
    FrameGraph alone, shared({.shareMemory = true});
    const auto frame = [&](FrameGraph& graph) {
        graph.beginFrame();
        const History history = graph.history("history", Format::R32Float, odd);
        const ImageHandle next = graph.transient("next", Format::R32Float, odd);
        const uint32_t valid = 1;
        const auto addOne = [&](const char* pass, ImageHandle from, ImageHandle to) {
            graph.dispatch({.pass = pass,
                            .shader = shaders::test_accumulate_comp,
                            .bindings = {{"previous", from}, {"current", to}},
                            .params = paramsOf(valid),
                            .extent = odd});
        };
        addOne("read", history.previous, next);
        addOne("write", next, history.current);
        graph.execute(device());
        return graph.downloadFloat(device(), history.current);
    };
    for (int i = 0; i < 6; ++i) {
        const std::vector<float> pixels = frame(shared);
        EXPECT_THAT(pixels, Each(static_cast<float>(2 * (i % 3 + 1))));
        EXPECT_EQ(pixels, frame(alone));
        if (i != 2) continue;
        shared.resetHistories();
        alone.resetHistories();
    }
    EXPECT_EQ(alone.imageBytes() - shared.imageBytes(), uint64_t{odd.width} * odd.height * 4);
}

TEST_F(GpuTest, AnImageWhoseMemoryWasReusedCannotBeDownloaded) {
    FrameGraph graph({.shareMemory = true});
    graph.beginFrame();
    const ImageHandle a = graph.transient("a", rgba, odd), b = graph.transient("b", rgba, odd);
    fill(graph, "fill", a);
    scale(graph, "read a", a, b);
    fill(graph, "reuse a", graph.transient("c", rgba, odd));
    graph.execute(device());
    EXPECT_EQ(graph.downloadFloat(device(), b)[0], 2.0f);
    EXPECT_THAT(faultOf([&] { graph.downloadFloat(device(), a); }), HasSubstr("its memory was reused"));
}

/// Clearing what is zero already would make the first frame after a warm-up slower than later ones.
TEST_F(GpuTest, InvalidHistoriesAreClearedOnlyIfTheyAreNotZero) {
    using Role = RecordedImage::Role;
    RecordedFrame frame;
    frame.images.push_back(
        {.name = "a (previous)", .key = {"a", 0, rgba, 4, 4}, .role = Role::Previous, .clear = true});
    frame.images.push_back(
        {.name = "a", .key = {"a", 1, rgba, 4, 4}, .role = Role::Current, .clear = true, .written = true});
    const auto executorOf = [&] {
        return FrameExecutor(device().impl().context, device().impl().pipelines, {});
    };
    FrameExecutor warm = executorOf(), cold = executorOf();
    const auto warmUp = [&] {
        device().impl().transfer().run([&](VkCommandBuffer commands) { warm.clear(frame, commands); });
    };
    warmUp();
    EXPECT_EQ(warm.clearedImages(), 2u);
    warm.execute(frame);
    EXPECT_EQ(warm.clearedImages(), 2u) << "nothing has written them since";
    warm.execute(frame);
    EXPECT_EQ(warm.clearedImages(), 3u) << "the frame before wrote one of the two";
    warmUp();
    EXPECT_EQ(warm.clearedImages(), 3u) << "a warm-up clears only what no frame has used";
    cold.execute(frame);
    EXPECT_EQ(cold.clearedImages(), 2u);
    cold.execute(frame);
    EXPECT_EQ(cold.clearedImages(), 3u);
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
    FrameGraph::Impl graph({});
    FrameExecutor executor(device().impl().context, device().impl().pipelines, {});
    for (uint32_t size = 1; size <= 40; ++size) {
        RecordedFrame frame;
        frame.images.push_back({.name = "a", .key = {"a", 0, rgba, size, size}});
        executor.execute(frame);
        EXPECT_LE(executor.pooledImages(), 3u) << "this frame's, and two that may be in use";
    }
}

TEST_F(GpuTest, ReleaseKeepsWhatIsNeededOrInUse) {
    ImagePool pool(device().impl().context, 2);
    const ImageKey needed{"needed", 0, rgba, 4, 4}, old{"old", 0, rgba, 4, 4}, busy{"busy", 0, rgba, 4, 4},
        failed{"failed", 0, rgba, 4, 4};
    for (const ImageKey& key : {needed, old, busy, failed}) pool.acquire(key, "");
    for (const ImageKey& key : {needed, old, busy}) pool.acquire(key, "").initialised = true;
    pool.acquire(busy, "").lastFrame = 7;
    EXPECT_TRUE(pool.release({needed}, 7));
    EXPECT_TRUE(pool.find(needed) && pool.find(busy));
    EXPECT_FALSE(pool.find(old) || pool.find(failed));
    EXPECT_FALSE(pool.release({needed}, 7)) << "nothing is left to free";
}

TEST_F(GpuTest, DownloadsEveryFormat) {
    FrameGraph graph;
    graph.beginFrame();
    constexpr const char* names[] = {"r32Float",   "r32Uint",  "rg32Float",   "rg32Uint",  "rgba32Float",
                                     "rgba32Uint", "r16Float", "rgba16Float", "rgba8Unorm"};
    std::vector<Binding> bindings;
    std::vector<ImageHandle> images;
    for (size_t i = 0; i < std::size(names); ++i) {
        images.push_back(graph.transient(names[i], allFormats()[i], odd));
        bindings.push_back({names[i], images.back()});
    }
    graph.dispatch(
        {.pass = "formats", .shader = shaders::test_formats_comp, .bindings = bindings, .extent = odd});
    graph.execute(device());
    for (size_t i = 0; i < std::size(names); ++i) {
        const Format format = allFormats()[i];
        const uint32_t components = componentCount(format);
        const bool isUint = toString(format).find("Uint") != std::string_view::npos;
        const size_t at = (size_t{3} * odd.width + 20) * components;  // of pixel (20, 3)
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
            if (unorm) {  // whole pixels, red in the lowest byte
                EXPECT_EQ(graph.downloadUint(device(), images[i])[at / 4], 0xff00ff14u);
                continue;
            }
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

TEST_F(GpuTest, ValidationSeesAMissingBarrier) {
    if (!validated_)
        GTEST_SKIP() << "NOT TESTED: the validation layer is not installed (vulkan-validationlayers).";
    expectNoMessages_ = false;
    // Runs the frame twice: as recorded, and without the hazards that cause its barriers.
    for (const bool barriers : {true, false}) {
        FrameGraph::Impl graph({});
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
        FrameExecutor executor(device().impl().context, device().impl().pipelines, {});
        executor.execute(graph.frame);
        if (barriers) {
            EXPECT_EQ(device().validationMessages(), 0u);
        } else {
            EXPECT_GT(device().validationMessages(), 0u);
        }
    }
}

}  // namespace
}  // namespace limpid::gpu
