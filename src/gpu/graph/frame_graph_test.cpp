// Tests recording; needs no device.
#include "gpu/graph/frame_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "base/error.h"
#include "gpu/graph/frame_graph_impl.h"
#include "test_accumulate.comp.h"
#include "test_buffers.comp.h"
#include "test_fill.comp.h"
#include "test_group_size.comp.h"
#include "test_increment.comp.h"
#include "test_scale.comp.h"
#include "test_unused.comp.h"

namespace limpid::gpu {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Extent small{20, 10};
constexpr Format rgba = Format::RGBA32Float;

struct FillParams {
    float values[7] = {};
};

std::string faultOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

/// A buffer without device memory, which is enough for recording.
Buffer fakeBuffer(const std::string& name, std::optional<Format> format = {}) {
    auto resource = std::make_shared<BufferResource>();
    resource->name = name;
    resource->size = 64;
    resource->format = format;
    return Buffer(std::move(resource));
}

class FrameGraphTest : public testing::Test {
  protected:
    explicit FrameGraphTest(const GraphOptions& options = {}) : graph(options) {}
    void SetUp() override { graph.beginFrame(); }

    void fill(std::string_view pass, ImageHandle image) {
        graph.dispatch({.pass = pass,
                        .shader = shaders::test_fill_comp,
                        .bindings = {{"result", image}},
                        .params = paramsOf(params),
                        .extent = graph.extent(image)});
    }
    void scale(std::string_view pass, ImageHandle source, ImageHandle result) {
        graph.dispatch({.pass = pass,
                        .shader = shaders::test_scale_comp,
                        .bindings = {{"source", source}, {"result", result}},
                        .extent = small});
    }
    void increment(std::string_view pass, ImageHandle image) {
        graph.dispatch({.pass = pass,
                        .shader = shaders::test_increment_comp,
                        .bindings = {{"value", image}},
                        .extent = small});
    }
    void writeCurrent(const History& history) { fill("write current", history.current); }
    void finishFrame() {
        graph.assumeExecuted();
        graph.beginFrame();
    }
    ImageHandle filled(const std::string& name) {
        const ImageHandle image = graph.transient(name, rgba, small);
        fill("fill " + name, image);
        return image;
    }
    /// Returns the error of a dispatch of test_scale.
    std::string scaleFault(std::vector<Binding> bindings, std::vector<ConstantValue> constants = {}) {
        return faultOf([&] {
            graph.dispatch({.pass = "demo/scale",
                            .shader = shaders::test_scale_comp,
                            .bindings = std::move(bindings),
                            .constants = std::move(constants),
                            .extent = small});
        });
    }

    FrameGraph graph;
    FillParams params;
};

MATCHER_P3(IsHazard, kind, resource, earlierPass, "") {
    return arg.kind == kind && arg.resource == resource && arg.earlierPass == earlierPass;
}

TEST_F(FrameGraphTest, RecordsPassesInOrderWithReadsAndWrites) {
    const ImageHandle a = filled("a");
    const ImageHandle b = graph.transient("b", rgba, small);
    scale("scale", a, b);
    increment("increment", b);
    ASSERT_EQ(graph.passes().size(), 3u);
    EXPECT_EQ(graph.passes()[0].name, "fill a");
    EXPECT_EQ(graph.passes()[1].shader, "gpu/tests/shaders/test_scale.comp");
    EXPECT_THAT(graph.passes()[0].reads, IsEmpty());
    EXPECT_THAT(graph.passes()[1].reads, ElementsAre("a"));
    EXPECT_THAT(graph.passes()[1].writes, ElementsAre("b"));
    EXPECT_THAT(graph.passes()[2].reads, ElementsAre("b"));
    EXPECT_THAT(graph.passes()[2].writes, ElementsAre("b"));
    EXPECT_EQ(graph.passes()[1].groups, (std::array<uint32_t, 3>{3, 2, 1}));
    EXPECT_THAT(graph.imagesWrittenBy("scale"), ElementsAre(b));
    EXPECT_THAT(graph.imagesWrittenBy("nothing"), IsEmpty());
    EXPECT_EQ(graph.name(b), "b");
    EXPECT_EQ(graph.format(b), rgba);
    EXPECT_EQ(graph.extent(b), small);
}

TEST_F(FrameGraphTest, AReadAfterAWriteWaitsOnce) {
    const ImageHandle a = filled("a");
    const ImageHandle other = filled("other");
    const ImageHandle b = graph.transient("b", rgba, small);
    const ImageHandle c = graph.transient("c", rgba, small);
    const ImageHandle d = graph.transient("d", rgba, small);
    scale("first", a, b);
    scale("second", a, c);
    scale("third", other, d);
    const auto& passes = graph.passes();
    EXPECT_THAT(passes[1].hazards, IsEmpty()) << "independent passes need no barrier";
    EXPECT_THAT(passes[2].hazards, ElementsAre(IsHazard(Hazard::Kind::ReadAfterWrite, "a", "fill a")));
    EXPECT_THAT(passes[3].hazards, IsEmpty()) << "the barrier before 'first' orders this read too";
    EXPECT_THAT(passes[4].hazards, IsEmpty()) << "'other' was written before that barrier as well";
}

TEST_F(FrameGraphTest, AWriteAfterAWriteAndAfterAReadWaits) {
    const ImageHandle a = filled("a");
    fill("again", a);
    EXPECT_THAT(graph.passes()[1].hazards,
                ElementsAre(IsHazard(Hazard::Kind::WriteAfterWrite, "a", "fill a")));
    const ImageHandle b = graph.transient("b", rgba, small);
    const ImageHandle c = graph.transient("c", rgba, small);
    scale("read 1", a, b);
    scale("read 2", a, c);
    fill("overwrite", a);
    EXPECT_THAT(graph.passes()[4].hazards,
                ElementsAre(IsHazard(Hazard::Kind::WriteAfterRead, "a", "read 1"),
                            IsHazard(Hazard::Kind::WriteAfterRead, "a", "read 2")));
}

TEST_F(FrameGraphTest, ReadingAndWritingWaitsForBoth) {
    const ImageHandle a = filled("a");
    increment("increment", a);
    EXPECT_THAT(graph.passes()[1].hazards,
                ElementsAre(IsHazard(Hazard::Kind::ReadAfterWrite, "a", "fill a"),
                            IsHazard(Hazard::Kind::WriteAfterWrite, "a", "fill a")));
    const ImageHandle b = graph.transient("b", rgba, small);
    scale("read", a, b);
    EXPECT_THAT(graph.passes()[2].hazards,
                ElementsAre(IsHazard(Hazard::Kind::ReadAfterWrite, "a", "increment")));
}

TEST_F(FrameGraphTest, BuffersThatShadersWriteAreTrackedToo) {
    const Buffer texels = fakeBuffer("texels", rgba), indices = fakeBuffer("indices", Format::R32Uint);
    const Buffer offsets = fakeBuffer("offsets"), counter = fakeBuffer("counter"), sums = fakeBuffer("sums");
    const auto dispatch = [&](std::string_view pass, const Buffer& read, const Buffer& written) {
        graph.dispatch({.pass = pass,
                        .shader = shaders::test_buffers_comp,
                        .bindings = {{"texels", &texels},
                                     {"indices", &indices},
                                     {"offsets", &read},
                                     {"counter", &counter},
                                     {"Sums", &written}},
                        .extent = {10, 1}});
    };
    dispatch("one", offsets, sums);
    dispatch("two", sums, offsets);
    EXPECT_THAT(graph.passes()[0].hazards, IsEmpty());
    EXPECT_THAT(graph.passes()[1].hazards,
                ElementsAre(IsHazard(Hazard::Kind::ReadAfterWrite, "sums", "one"),
                            IsHazard(Hazard::Kind::ReadAfterWrite, "counter", "one"),
                            IsHazard(Hazard::Kind::WriteAfterWrite, "counter", "one"),
                            IsHazard(Hazard::Kind::WriteAfterRead, "offsets", "one")));
    EXPECT_THAT(faultOf([&] { dispatch("race", sums, sums); }),
                AllOf(HasSubstr("'race'"), HasSubstr("'Sums'"), HasSubstr("also bound to 'offsets'")));
    const Buffer none;
    EXPECT_THAT(faultOf([&] { dispatch("none", none, sums); }), HasSubstr("'offsets': the buffer is empty"));
    EXPECT_THAT(faultOf([&] { dispatch("kind", texels, sums); }),
                HasSubstr("'offsets': is a storage buffer in the shader, but 'texels' is a texel buffer"));
}

TEST_F(FrameGraphTest, TexelBuffersMustHaveTheShadersFormat) {
    const Buffer wrong = fakeBuffer("wrong", Format::R32Float);
    EXPECT_THAT(faultOf([&] {
                    graph.dispatch({.pass = "demo",
                                    .shader = shaders::test_buffers_comp,
                                    .bindings = {{"texels", &wrong}},
                                    .extent = {1, 1}});
                }),
                HasSubstr("'texels': is RGBA32Float in the shader, but texel buffer 'wrong' is R32Float"));
}

TEST_F(FrameGraphTest, WhatPassesWriteIsCountedOnceAndHistoriesTwice) {
    constexpr uint64_t bytes = uint64_t{small.width} * small.height * 16;
    const ImageHandle input = filled("input");
    const ImageHandle b = graph.transient("b", rgba, small);
    scale("first", input, b);
    increment("again", b);
    const History history = graph.history("history", rgba, small);
    scale("keep", b, history.current);
    graph.transient("never written", rgba, small);
    EXPECT_EQ(graph.bytesOfImagesWrittenFrom(3), 2 * bytes);
    EXPECT_EQ(graph.bytesOfImagesWrittenFrom(1), 3 * bytes);
    EXPECT_EQ(graph.bytesOfImagesWrittenFrom(0), 4 * bytes);
    EXPECT_EQ(graph.bytesOfImagesWrittenFrom(4), 0u);
}

TEST_F(FrameGraphTest, HistoriesBecomeValidAndSwap) {
    const History first = graph.history("h", rgba, small);
    EXPECT_FALSE(first.valid);
    EXPECT_EQ(graph.name(first.current), "h");
    EXPECT_EQ(graph.name(first.previous), "h (previous)");
    writeCurrent(first);
    finishFrame();
    const History second = graph.history("h", rgba, small);
    EXPECT_TRUE(second.valid);
    EXPECT_NE(second.current, first.current) << "handles of another frame are other handles";
}

TEST_F(FrameGraphTest, HistoriesStartAnewAfterResizeFormatResetAbsenceAndUnwrittenFrames) {
    const auto frame = [&](Format format, Extent extent) {
        const History history = graph.history("h", format, extent);
        if (format == rgba) writeCurrent(history);
        finishFrame();
        return history.valid;
    };
    EXPECT_FALSE(frame(rgba, small));
    EXPECT_TRUE(frame(rgba, small));
    EXPECT_FALSE(frame(rgba, {30, 10})) << "resized";
    EXPECT_TRUE(frame(rgba, {30, 10}));
    EXPECT_FALSE(frame(Format::R32Float, {30, 10})) << "another format";
    EXPECT_FALSE(frame(rgba, {30, 10})) << "and back; the frame before did not write it";
    EXPECT_TRUE(frame(rgba, {30, 10}));
    finishFrame();
    EXPECT_FALSE(frame(rgba, {30, 10})) << "a frame left it out";
    EXPECT_TRUE(frame(rgba, {30, 10}));
    graph.resetHistories();
    EXPECT_TRUE(frame(rgba, {30, 10})) << "a reset counts from the next frame on";
    EXPECT_FALSE(frame(rgba, {30, 10})) << "reset";
    EXPECT_TRUE(frame(rgba, {30, 10}));
}

TEST_F(FrameGraphTest, AFrameThatIsNotExecutedLeavesHistoriesAlone) {
    writeCurrent(graph.history("h", rgba, small));
    finishFrame();
    EXPECT_TRUE(graph.history("h", rgba, small).valid);
    graph.beginFrame();  // for example, because an error stopped the frame
    EXPECT_TRUE(graph.history("h", rgba, small).valid);
    graph.beginFrame();
    graph.beginFrame();
    EXPECT_TRUE(graph.history("h", rgba, small).valid);
}

TEST_F(FrameGraphTest, AHistorysPreviousCanAlwaysBeReadAndNeverWritten) {
    const History history = graph.history("h", rgba, small);
    const ImageHandle out = graph.transient("out", rgba, small);
    scale("read previous", history.previous, out);
    EXPECT_THAT(faultOf([&] { fill("write previous", history.previous); }),
                AllOf(HasSubstr("'write previous'"), HasSubstr("'result'"), HasSubstr("can only be read")));
    EXPECT_THAT(scaleFault({{"source", history.current}, {"result", out}}),
                AllOf(HasSubstr("'source'"), HasSubstr("'h', which no pass of this frame has written")));
}

TEST_F(FrameGraphTest, NamesAreUniqueWithinAFrame) {
    graph.transient("a", rgba, small);
    EXPECT_THAT(faultOf([&] { graph.transient("a", rgba, small); }), HasSubstr("image 'a' is created twice"));
    EXPECT_THAT(faultOf([&] { graph.history("a", rgba, small); }), HasSubstr("image 'a' is created twice"));
    EXPECT_THAT(faultOf([&] { graph.transient("", rgba, small); }), HasSubstr("needs a name"));
    EXPECT_THAT(faultOf([&] { graph.transient("b", rgba, {0, 5}); }), HasSubstr("image 'b' is empty: 0 x 5"));
    graph.beginFrame();
    EXPECT_TRUE(graph.transient("a", rgba, small));
}

TEST_F(FrameGraphTest, HandlesEndWithTheirFrame) {
    const ImageHandle old = filled("a");
    graph.beginFrame();
    const ImageHandle now = filled("a");
    EXPECT_NE(old, now);
    EXPECT_THAT(faultOf([&] { graph.extent(old); }), HasSubstr("from an earlier frame"));
    EXPECT_THAT(faultOf([&] { graph.name({}); }), HasSubstr("handle is empty"));
    const ImageHandle out = graph.transient("out", rgba, small);
    EXPECT_THAT(
        scaleFault({{"source", old}, {"result", out}}),
        AllOf(HasSubstr("pass 'demo/scale'"), HasSubstr("'source'"), HasSubstr("from an earlier frame")));
    EXPECT_THAT(scaleFault({{"source", ImageHandle{}}, {"result", out}}), HasSubstr("handle is empty"));
}

TEST_F(FrameGraphTest, ErrorsNamePassAndVariable) {
    const ImageHandle a = filled("a"), raw = graph.transient("raw", rgba, small);
    const ImageHandle uint = graph.transient("uint", Format::R32Uint, small);
    const Buffer buffer = fakeBuffer("buffer");
    const size_t before = graph.passes().size();
    const auto names = [](const char* variable, const char* fault) {
        return AllOf(HasSubstr("pass 'demo/scale' (gpu/tests/shaders/test_scale.comp)"),
                     HasSubstr("variable '" + std::string(variable) + "'"), HasSubstr(fault));
    };
    EXPECT_THAT(scaleFault({{"result", raw}}), names("source", "nothing is bound to this image"));
    EXPECT_THAT(scaleFault({{"source", a}, {"result", raw}, {"more", a}}), names("more", "no such variable"));
    EXPECT_THAT(scaleFault({{"source", a}, {"source", a}, {"result", raw}}),
                names("source", "is bound twice"));
    EXPECT_THAT(scaleFault({{"source", raw}, {"result", raw}}),
                names("source", "no pass of this frame has written"));
    EXPECT_THAT(scaleFault({{"source", a}, {"result", a}}), names("result", "'a' is also bound to 'source'"));
    EXPECT_THAT(scaleFault({{"source", a}, {"result", uint}}),
                names("result", "is RGBA32Float in the shader, but image 'uint' is R32Uint"));
    EXPECT_THAT(scaleFault({{"source", &buffer}, {"result", raw}}), names("source", "but a buffer is bound"));
    EXPECT_EQ(graph.passes().size(), before) << "a refused dispatch leaves nothing behind";
    EXPECT_THAT(scaleFault({{"source", raw}, {"result", graph.transient("x", rgba, small)}}),
                HasSubstr("no pass"))
        << "and its writes did not happen";
}

TEST_F(FrameGraphTest, ParamsMustFitTheUniformBlock) {
    const ImageHandle a = graph.transient("a", rgba, small);
    const float tooShort[3] = {};
    const auto fault = [&](const ShaderCode& shader, std::vector<Binding> bindings,
                           std::span<const std::byte> bytes) {
        return faultOf([&] {
            graph.dispatch({.pass = "demo",
                            .shader = shader,
                            .bindings = std::move(bindings),
                            .params = bytes,
                            .extent = small});
        });
    };
    EXPECT_THAT(
        fault(shaders::test_fill_comp, {{"result", a}}, paramsOf(tooShort)),
        AllOf(HasSubstr("'demo'"), HasSubstr("'params': the uniform block has 28 bytes, but params has 12")));
    EXPECT_THAT(fault(shaders::test_fill_comp, {{"result", a}}, {}), HasSubstr("but params has 0"));
    EXPECT_THAT(fault(shaders::test_fill_comp, {{"result", a}, {"params", a}}, paramsOf(params)),
                HasSubstr("'params': is the uniform block, which is filled from `params`"));
    fill("fill", a);
    EXPECT_THAT(fault(shaders::test_increment_comp, {{"value", a}}, paramsOf(params)),
                HasSubstr("params has 28 bytes, but the shader has no uniform block"));
}

TEST_F(FrameGraphTest, ConstantsMustExist) {
    const ImageHandle a = filled("a"), b = graph.transient("b", rgba, small);
    const std::vector<Binding> bindings{{"source", a}, {"result", b}};
    EXPECT_THAT(scaleFault(bindings, {{"nothing", 1}}),
                AllOf(HasSubstr("'demo/scale'"), HasSubstr("constant 'nothing'")));
    EXPECT_THAT(scaleFault(bindings, {{"bias", 1}, {"bias", 2}}), HasSubstr("set twice"));
    EXPECT_EQ(scaleFault(bindings, {{"bias", 1}}), "no error");
}

TEST_F(FrameGraphTest, ConstantsMaySetTheWorkgroupSize) {
    const ImageHandle a = graph.transient("a", Format::RG32Uint, {64, 64});
    const auto dispatch = [&](std::vector<ConstantValue> constants) {
        graph.dispatch({.pass = "size",
                        .shader = shaders::test_group_size_comp,
                        .bindings = {{"result", a}},
                        .constants = std::move(constants),
                        .extent = {64, 64}});
        return graph.passes().back().groups;
    };
    EXPECT_EQ(dispatch({}), (std::array<uint32_t, 3>{8, 16, 1}));
    EXPECT_EQ(dispatch({{"groupWidth", 16}}), (std::array<uint32_t, 3>{4, 16, 1}));
    EXPECT_THAT(faultOf([&] { dispatch({{"groupWidth", 0}}); }), HasSubstr("workgroup empty"));
}

TEST_F(FrameGraphTest, AnEmptyExtentOrPassNameIsAnError) {
    const ImageHandle a = graph.transient("a", rgba, small);
    const auto dispatch = [&](std::string_view pass, Extent extent) {
        return faultOf([&] {
            graph.dispatch({.pass = pass,
                            .shader = shaders::test_fill_comp,
                            .bindings = {{"result", a}},
                            .params = paramsOf(params),
                            .extent = extent});
        });
    };
    EXPECT_THAT(dispatch("demo", {0, 1}), AllOf(HasSubstr("'demo'"), HasSubstr("extent is empty: 0 x 1")));
    EXPECT_THAT(dispatch("", small), HasSubstr("needs a name"));
    EXPECT_EQ(dispatch("demo", {UINT32_MAX, 1}), "no error") << "the group count must not overflow";
    EXPECT_EQ(graph.passes().back().groups[0], 1u << 29);
}

TEST_F(FrameGraphTest, UnusedVariablesMustBeBound) {
    const ImageHandle a = graph.transient("a", rgba, small);
    EXPECT_THAT(faultOf([&] {
                    graph.dispatch({.pass = "demo",
                                    .shader = shaders::test_unused_comp,
                                    .bindings = {{"result", a}},
                                    .extent = small});
                }),
                HasSubstr("'unused': nothing is bound"));
}

class MemorySharingTest : public FrameGraphTest {
  protected:
    MemorySharingTest() : FrameGraphTest(GraphOptions{.shareMemory = true}) {}
    /// Records a pass that only reads.
    void read(std::string_view pass, ImageHandle image) {
        scale(pass, image, graph.transient("of " + std::string(pass), rgba, small));
    }
    static constexpr uint64_t imageSize = uint64_t{small.width} * small.height * 16;
};

TEST_F(MemorySharingTest, AnImageTakesTheMemoryOfOneThatIsNoLongerRead) {
    const ImageHandle a = filled("a"), b = graph.transient("b", rgba, small);
    scale("first", a, b);
    const ImageHandle c = graph.transient("c", rgba, small);
    scale("second", b, c);  // b is still read, a is not
    EXPECT_EQ(graph.imageBytes(), 2 * imageSize);
    const ImageHandle d = graph.transient("d", rgba, small);
    scale("third", c, d);
    EXPECT_EQ(graph.imageBytes(), 2 * imageSize);
    EXPECT_EQ(graph.bytesOfImagesWrittenFrom(0), 2 * imageSize);
}

TEST_F(MemorySharingTest, ResultsKeepTheirMemory) {
    const ImageHandle a = filled("a");  // written last: the frame's result
    const ImageHandle b = filled("b");
    filled("c");
    EXPECT_EQ(graph.imageBytes(), 3 * imageSize);
    EXPECT_EQ(graph.largestBufferBytes(), 0u);
    read("reader of a", a);
    read("reader of b", b);
    EXPECT_EQ(graph.imageBytes(), 4 * imageSize) << "the second reader's result takes the memory of a";
}

TEST_F(MemorySharingTest, OnlyImagesOfOneKindShare) {
    const ImageHandle a = filled("a");
    read("reader of a", a);
    const ImageHandle other = graph.transient("other", rgba, {small.width, small.height + 1});
    fill("fill other", other);
    EXPECT_EQ(graph.imageBytes(), 3 * imageSize + uint64_t{small.width} * 16);
    filled("same");
    EXPECT_EQ(graph.imageBytes(), 3 * imageSize + uint64_t{small.width} * 16);
}

TEST_F(MemorySharingTest, BuffersNeedNotHaveOneFormat) {
    const ImageHandle words = graph.transient("words", Format::RGBA32Uint, small, Backing::Buffer);
    graph.host({.pass = "write words", .reads = {}, .writes = {words}, .run = {}});
    graph.host({.pass = "read words", .reads = {words}, .writes = {}, .run = {}});
    const ImageHandle floats = graph.transient("floats", rgba, small, Backing::Buffer);
    graph.host({.pass = "write floats", .reads = {}, .writes = {floats}, .run = {}});
    EXPECT_EQ(graph.imageBytes(), imageSize);
    const ImageHandle pairs = graph.transient("pairs", Format::RG32Float, small, Backing::Buffer);
    graph.host({.pass = "write pairs", .reads = {}, .writes = {pairs}, .run = {}});
    EXPECT_EQ(graph.imageBytes(), imageSize + imageSize / 2);
    EXPECT_EQ(graph.largestBufferBytes(), imageSize);
}

TEST_F(MemorySharingTest, AHistorysPreviousImageGivesItsMemoryAndTheCurrentOneDoesNot) {
    const History history = graph.history("history", rgba, small);
    writeCurrent(history);
    read("reader", history.previous);
    read("reader of current", history.current);
    EXPECT_EQ(graph.imageBytes(), 3 * imageSize) << "the second reader's result is where the past was";
}

TEST_F(MemorySharingTest, AHistoryIsWrittenInPlaceIfItsPastIsNoLongerRead) {
    const auto frame = [&](bool inPlace) {
        graph.beginFrame();
        const History history = graph.history("history", rgba, small);
        const ImageHandle result = graph.transient("result", rgba, small);
        if (!inPlace) writeCurrent(history);
        scale("reader", history.previous, result);
        if (inPlace) scale("writer", result, history.current);
        read("later reader", history.current);
        graph.assumeExecuted();
        return history.valid;
    };
    EXPECT_FALSE(frame(true));
    EXPECT_EQ(graph.imageBytes(), 2 * imageSize) << "the later reader's result is where the first's was";
    EXPECT_EQ(graph.bytesOfImagesWrittenFrom(0), 2 * imageSize);
    EXPECT_TRUE(frame(true)) << "the past survives";
    EXPECT_TRUE(frame(false));
    EXPECT_EQ(graph.imageBytes(), 3 * imageSize) << "the later reader's result is where the past was";
    EXPECT_TRUE(frame(true));
}

TEST_F(MemorySharingTest, AnUploadedImageKeepsItsOwnMemoryUntilItWasRead) {
    const ImageHandle a = filled("a");
    read("reader of a", a);
    const ImageHandle uploaded = graph.transient("uploaded", rgba, small);
    graph.upload(uploaded, std::vector<std::byte>(imageSize));  // before the first pass
    read("reader of uploaded", uploaded);
    EXPECT_EQ(graph.imageBytes(), 3 * imageSize) << "a gives to the second reader's result";
    filled("later");
    EXPECT_EQ(graph.imageBytes(), 3 * imageSize) << "what was uploaded gives to the later one";
}

TEST(FrameGraph, NeedsABegunFrame) {
    FrameGraph graph;
    EXPECT_THAT(faultOf([&] { graph.transient("a", rgba, small); }), HasSubstr("call beginFrame() first"));
    graph.beginFrame();
    graph.transient("a", rgba, small);
    graph.assumeExecuted();
    EXPECT_THAT(faultOf([&] { graph.transient("b", rgba, small); }), HasSubstr("has been executed"));
    EXPECT_THAT(faultOf([&] { graph.assumeExecuted(); }), HasSubstr("has been executed"));
}

/// Returns a shader with another's name.
ShaderCode renamed(ShaderCode code) {
    code.name = "demo";
    return code;
}

TEST(FrameGraph, ChangedShaderCodeUnderTheSameNameIsAnotherShader) {
    FrameGraph graph;
    graph.beginFrame();
    const ShaderCode before = renamed(shaders::test_increment_comp);
    const ShaderCode after = renamed(shaders::test_unused_comp);
    const ImageHandle a = graph.transient("a", rgba, small);
    EXPECT_THAT(
        faultOf([&] {
            graph.dispatch({.pass = "p", .shader = before, .bindings = {{"result", a}}, .extent = small});
        }),
        HasSubstr("'result': the shader declares no such variable"));
    EXPECT_THAT(
        faultOf([&] {
            graph.dispatch({.pass = "p", .shader = after, .bindings = {{"result", a}}, .extent = small});
        }),
        HasSubstr("'unused': nothing is bound"));
}

TEST(FrameGraph, KeepsAReplacementAsLongAsItIsUsed) {
    FrameGraph graph;
    ShaderReplacements replacements;
    const auto replacement = std::make_shared<const ShaderCode>(renamed(shaders::test_unused_comp));
    replacements["demo"] = replacement;
    graph.setReplacements(&replacements);
    graph.beginFrame();
    const ImageHandle a = graph.transient("a", rgba, small);
    const auto record = [&] {
        const ShaderCode code = renamed(shaders::test_increment_comp);
        graph.dispatch({.pass = "p", .shader = code, .bindings = {{"result", a}}, .extent = small});
    };
    EXPECT_THAT(faultOf(record), HasSubstr("'unused': nothing is bound"));
    ASSERT_EQ(graph.usedShaders().size(), 1u);
    EXPECT_EQ(graph.usedShaders()[0].words.data(), shaders::test_unused_comp.words.data());
    replacements.clear();
    EXPECT_EQ(replacement.use_count(), 2) << "the shader that was made of it lives";
    EXPECT_THAT(faultOf(record), HasSubstr("'result': the shader declares no such variable"));
    EXPECT_EQ(replacement.use_count(), 1);
}

}  // namespace
}  // namespace limpid::gpu
