// Tests when pipelines are made, and when they are destroyed.
#include <gtest/gtest.h>

#include <thread>

#include "gpu/tests/gpu_test_fixture.h"
#include "test_group_size.comp.h"

namespace limpid::gpu {
namespace {

/// A pipeline for each width.
void dispatchSize(FrameGraph& graph, ImageHandle image, uint32_t width, Extent extent) {
    graph.dispatch({.pass = "size",
                    .shader = shaders::test_group_size_comp,
                    .bindings = {{"result", image}},
                    .constants = {{"groupWidth", width}, {"groupHeight", 4}},
                    .extent = extent});
}

TEST_F(GpuTest, NewPipelinesAreAnnouncedOnce) {
    FrameGraph graph;
    size_t before = device().pipelineCount();
    int announced = 0;
    device().onNewPipelines([&] {
        ++announced;
        EXPECT_EQ(device().pipelineCount(), before) << "too late";
    });
    const auto run = [&](uint32_t width) {
        graph.beginFrame();
        const ImageHandle image = graph.transient("size", Format::RG32Uint, odd);
        dispatchSize(graph, image, width, odd);
        graph.execute(device());
    };
    run(8);
    EXPECT_EQ(announced, 1);
    run(8);
    EXPECT_EQ(announced, 1);
    before = device().pipelineCount();
    run(16);
    EXPECT_EQ(announced, 2);
    EXPECT_EQ(device().pipelineCount(), before + 1);
    // What another thread compiles meanwhile is no news of a frame.
    FrameGraph other;
    other.beginFrame();
    const ImageHandle image = other.transient("size", Format::RG32Uint, odd);
    dispatchSize(other, image, 2, odd);
    EXPECT_FALSE(other.isPrepared(device()));
    std::jthread([&] { other.prepareBeside(device()); }).join();
    EXPECT_TRUE(other.isPrepared(device()));
    run(2);
    EXPECT_EQ(announced, 2);
    device().onNewPipelines({});
    run(4);
    EXPECT_EQ(announced, 2);
}

TEST_F(GpuTest, PipelinesThatAreNotUsedForLongAreDestroyed) {
    Device few({.select = device().info().name, .validation = validated_, .mostPipelines = 4});
    FrameGraph graph;
    const auto run = [&](uint32_t width, int dispatches) {
        graph.beginFrame();
        const ImageHandle image = graph.transient("size", Format::RG32Uint, {3, 2});
        for (int i = 0; i < dispatches; ++i) {
            dispatchSize(graph, image, width, Extent{3, 2});
        }
        graph.execute(few);
        EXPECT_EQ(graph.downloadUint(few, image).at(0), width);
    };
    for (uint32_t width = 1; width <= 6; ++width) run(width, 1);
    EXPECT_EQ(few.keptPipelineCount(), 6u) << "recently used";
    for (int frame = 0; frame < 16; ++frame) run(6, 64);
    EXPECT_EQ(few.keptPipelineCount(), 6u) << "only new ones need room";
    run(7, 1);
    EXPECT_EQ(few.keptPipelineCount(), 4u);
    EXPECT_EQ(few.pipelineCount(), 7u);
    run(6, 1);
    EXPECT_EQ(few.pipelineCount(), 7u) << "what each frame used exists";
    run(1, 1);
    EXPECT_EQ(few.pipelineCount(), 8u) << "made again";
    EXPECT_EQ(few.validationMessages(), 0u);
}

TEST_F(GpuTest, PipelinesInUseAreNotDestroyed) {
    Device one({.select = device().info().name, .validation = validated_, .mostPipelines = 1});
    FrameGraph graph;
    ImageHandle image;
    const auto begin = [&] {
        graph.beginFrame();
        image = graph.transient("size", Format::RG32Uint, {3, 2});
    };
    const auto dispatch = [&](uint32_t width) { dispatchSize(graph, image, width, Extent{3, 2}); };
    // The second frame takes the first pipeline's place while the device may still compute the first frame.
    begin();
    dispatch(1);
    for (int i = 0; i < 1100; ++i) dispatch(2);
    graph.execute(one);
    begin();
    dispatch(3);
    graph.execute(one);
    EXPECT_EQ(one.keptPipelineCount(), 2u);
    EXPECT_EQ(graph.downloadUint(one, image).at(0), 3u);
    EXPECT_EQ(one.validationMessages(), 0u);

    // What a frame needs does not make room for what it lacks.
    begin();
    for (int i = 0; i < 1100; ++i) dispatch(3);
    graph.execute(one);
    const size_t made = one.pipelineCount();
    begin();
    dispatch(2);
    dispatch(4);
    graph.prepare(one);
    graph.execute(one);
    EXPECT_EQ(one.pipelineCount(), made + 1);
}

}  // namespace
}  // namespace limpid::gpu
