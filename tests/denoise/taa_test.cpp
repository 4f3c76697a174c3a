// Compares the pass of temporal anti-aliasing with the version in double precision, on identical inputs: each
// frame starts from what the device stored in the previous frame.
#include "denoise/stages/taa/taa.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/denoise/denoise_fixture.h"
#include "tests/oracle/double_taa.h"

namespace limpid::test {
namespace {

struct Case {
    const char* name;
    SyntheticOptions options;
    float frames = 8.0f;
    uint32_t columns = 101, rows = 57;
    int resizeAt = -1;     ///< from this frame on the picture is smaller
    float light = 1.0f;    ///< factor of the scene's light
    bool hasNans = false;  ///< and infinities, in distance and motion
    gpu::Backing filters = gpu::Backing::Image;
    bool jitters = false;  ///< each frame's rays go through another point of the pixels
};

denoise::TaaSettings settingsOf(const Case& c) {
    return {.frames = c.frames, .stillFrames = 10.0f};
}

std::string nameOf(const testing::TestParamInfo<Case>& info) {
    return info.param.name;
}

/// Returns a picture with the frame's content: hard edges, and noise if the scene has any.
std::vector<float> beautyOf(const HostFrame& frame) {
    std::vector<float> beauty(frame.diffuse.size(), 1.0f);
    for (size_t i = 0; i < beauty.size(); ++i) {
        if (i % 4 != 3) beauty[i] = frame.diffuse[i] + frame.specular[i] + frame.emission[i];
    }
    return beauty;
}

/// The position in float32 may be off by about 2^-16 of a pixel, which explains 1e-4 of the slope.
dvec3 toleranceOf(const TaaPixel& expected) {
    return 1e-5 * expected.mean + 1e-4 * expected.slope + expected.rounding;
}

bool isNear(const dvec3& value, const dvec3& expected, const dvec3& tolerance) {
    return glm::all(glm::lessThanEqual(glm::abs(value - expected), tolerance));
}

/// Compares the history for the next frame.
bool isStored(const dvec4& stored, const TaaPixel& expected) {
    // An error of the position, 2^-16 of a pixel, changes the number of slow pixels' frames by 10 / 0.1 of
    // it.
    constexpr double rounding = 1e-3, stillness = 2e-3, minHalf = 1e-7, largestHalf = 65504.0;
    return isNear(dvec3(stored), glm::min(expected.mean, dvec3(largestHalf)),
                  toleranceOf(expected) + rounding * expected.mean + minHalf) &&
           std::abs(stored.w - expected.frames) <= rounding * expected.frames + stillness;
}

class TaaPassTest : public DenoiseTest, public testing::WithParamInterface<Case> {
  protected:
    static HostFrame frameOf(int number);
    static vec2 jitterOf(int number);
    void antialias(const HostFrame& frame, const std::vector<float>& beauty, vec2 jitter);
    void compare(const HostFrame& frame, const std::vector<float>& beauty, vec2 jitter);
    gpu::ImageHandle stored() const;

    gpu::ImageHandle result_;
    TaaPast past_;
    size_t restarted_ = 0, full_ = 0;  ///< pixels of the last frame: without history; with a mean over all
                                       ///< frames
};

HostFrame TaaPassTest::frameOf(int number) {
    const Case& c = GetParam();
    const bool small = c.resizeAt >= 0 && number >= c.resizeAt;
    HostFrame frame = SyntheticScene(c.options).frame(number, small ? 61 : c.columns, small ? 43 : c.rows, 7);
    for (auto* layer : {&frame.diffuse, &frame.specular, &frame.emission}) {
        for (float& value : *layer) value *= c.light;
    }
    if (!c.hasNans) return frame;
    size_t at = 4 * static_cast<size_t>(number + 1);
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        for (const auto& [layer, component] :
             {std::pair{&frame.depth, 0u}, {&frame.motion, 0u}, {&frame.motion, 1u}}) {
            for (size_t i = at + component; i < layer->size(); i += 4 * 97) (*layer)[i] = bad;
            at += 4 * 13;
        }
    }
    return frame;
}

/// Reaches both ends of the pixel.
vec2 TaaPassTest::jitterOf(int number) {
    if (!GetParam().jitters) return vec2(0.0f);
    return vec2(static_cast<float>(number % 3) - 1.0f, static_cast<float>(number % 5) / 2.0f - 1.0f) / 2.0f;
}

void TaaPassTest::antialias(const HostFrame& frame, const std::vector<float>& beauty, vec2 jitter) {
    graph_.beginFrame();
    denoise::DenoiserInput input = denoise::upload(graph_, frame);
    input.filters = GetParam().filters;
    input.jitter = jitter;
    const gpu::ImageHandle picture =
        graph_.transient("picture", gpu::Format::RGBA32Float, {frame.width, frame.height});
    graph_.upload(picture, gpu::bytesOf(beauty));
    result_ = denoise::antialias(graph_, input, picture, settingsOf(GetParam()));
    graph_.execute(device());
}

/// Returns the other image that the pass writes.
gpu::ImageHandle TaaPassTest::stored() const {
    const std::vector<gpu::ImageHandle> images = graph_.imagesWrittenBy("taa");
    if (images.size() != 2) throw Error("the pass does not write its result and a history");
    return images[0] == result_ ? images[1] : images[0];
}

void TaaPassTest::compare(const HostFrame& frame, const std::vector<float>& beauty, vec2 jitter) {
    const denoise::TaaSettings settings = settingsOf(GetParam());
    const std::vector<TaaPixel> expected =
        taa(frame, beauty, past_, {settings.frames, std::max(settings.frames, settings.stillFrames)},
            dvec2(jitter));
    const std::vector<dvec4> result = download(result_);
    past_ = {frame.width, frame.height, download(stored())};
    ASSERT_EQ(result.size(), expected.size());
    ASSERT_EQ(past_.mean.size(), expected.size());
    size_t doubtful = 0, wrong = 0, firstWrong = 0;
    restarted_ = full_ = 0;
    for (size_t p = 0; p < expected.size(); ++p) {
        const TaaPixel& pixel = expected[p];
        ASSERT_EQ(result[p].w, 1.0) << p;
        restarted_ += pixel.frames == 1.0;
        full_ += pixel.frames >= double{GetParam().frames};
        doubtful += pixel.doubtful;
        if (pixel.doubtful ||
            (isNear(dvec3(result[p]), pixel.mean, toleranceOf(pixel)) && isStored(past_.mean[p], pixel)))
            continue;
        if (wrong++ == 0) firstWrong = p;
    }
    const size_t few = expected.size() / 1000;
    EXPECT_LE(doubtful, few);
    const TaaPixel& pixel = expected[firstWrong];
    const dvec4 &is = result[firstWrong], &kept = past_.mean[firstWrong];
    EXPECT_LE(wrong, few) << "the first is pixel " << firstWrong << ": " << is.x << ' ' << is.y << ' ' << is.z
                          << ", stored " << kept.x << ' ' << kept.y << ' ' << kept.z << " of " << kept.w
                          << " frames, not " << pixel.mean.x << ' ' << pixel.mean.y << ' ' << pixel.mean.z
                          << " of " << pixel.frames;
}

TEST_P(TaaPassTest, AgreesWithTheFormulasInDouble) {
    const Case& c = GetParam();
    for (int number = 0; number < 12; ++number) {
        SCOPED_TRACE("frame " + std::to_string(number));
        const HostFrame frame = frameOf(number);
        const std::vector<float> beauty = beautyOf(frame);
        antialias(frame, beauty, jitterOf(number));
        compare(frame, beauty, jitterOf(number));
        if (HasFatalFailure()) return;
        if (number == 0 || number == c.resizeAt) {
            EXPECT_EQ(restarted_, frame.pixelCount());
        }
    }
    if (c.resizeAt >= 0) return;
    EXPECT_GT(full_, 0u);
    if (c.options.cameraMoves && c.columns > 50) {
        EXPECT_GT(restarted_, 0u) << "what comes into the picture";
    }
}

const SyntheticOptions moving{.cameraMoves = true, .objectMoves = true};

INSTANTIATE_TEST_SUITE_P(
    Cases, TaaPassTest,
    testing::Values(
        Case{"Static", {}}, Case{"Camera", {.cameraMoves = true}}, Case{"Object", {.objectMoves = true}},
        Case{"Both", moving}, Case{"Noiseless", {.cameraMoves = true, .objectMoves = true, .noise = false}},
        Case{"Orthographic", {.cameraMoves = true, .objectMoves = true, .orthographic = true}},
        Case{"LargeScale", {.cameraMoves = true, .objectMoves = true, .scale = 1024}},
        Case{"FewFrames", moving, 2.5f}, Case{"Tiny", moving, 4.0f, 3, 2}, Case{"Thin", {}, 4.0f, 1, 40},
        Case{"Even", moving, 8.0f, 128, 64}, Case{.name = "Resize", .options = moving, .resizeAt = 6},
        Case{.name = "Bright", .options = moving, .light = 1e4f},
        Case{.name = "Dark", .options = moving, .light = 1e-3f},
        Case{.name = "Nans", .options = moving, .hasNans = true},
        Case{.name = "Buffers", .options = moving, .filters = gpu::Backing::Buffer},
        Case{.name = "JitteredStatic", .options = {}, .frames = 2.0f, .jitters = true},
        Case{.name = "JitteredObject", .options = {.objectMoves = true}, .frames = 2.0f, .jitters = true},
        Case{.name = "Jittered", .options = moving, .jitters = true},
        Case{.name = "JitteredBright", .options = moving, .light = 1e4f, .jitters = true},
        Case{.name = "JitteredBuffers", .options = moving, .filters = gpu::Backing::Buffer, .jitters = true},
        Case{"TinyBuffers", moving, 4.0f, 3, 2, -1, 1.0f, false, gpu::Backing::Buffer}),
    nameOf);

/// Recording needs no device.
TEST(Taa, OneFrameIsThePictureItself) {
    gpu::FrameGraph graph;
    graph.beginFrame();
    const HostFrame frame = SyntheticScene({}).frame(0, 16, 9, 1);
    const denoise::DenoiserInput input = denoise::upload(graph, frame);
    const size_t before = graph.passes().size();
    EXPECT_EQ(denoise::antialias(graph, input, input.emission, {}), input.emission);
    EXPECT_EQ(denoise::antialias(graph, input, input.emission, {.frames = 1.0f}), input.emission);
    EXPECT_EQ(graph.passes().size(), before);
    EXPECT_NE(denoise::antialias(graph, input, input.emission, {.frames = 2.0f}), input.emission);
    EXPECT_EQ(graph.passes().size(), before + 1);
}

/// Frames whose edges may be smooth already are not smoothed again.
TEST(Taa, EdgesAreSmoothedInJitteredFrames) {
    const HostFrame frame = SyntheticScene({}).frame(0, 16, 9, 1);
    const auto passes = [&](bool jitters, const denoise::TaaSettings& settings) {
        gpu::FrameGraph graph;
        graph.beginFrame();
        denoise::DenoiserInput input = denoise::upload(graph, frame);
        input.jitterChanges = jitters;
        const size_t before = graph.passes().size();
        denoise::antialias(graph, input, input.emission, settings);
        return graph.passes().size() - before;
    };
    EXPECT_EQ(passes(false, {.frames = 2.0f}), 1u);
    EXPECT_EQ(passes(true, {}), 3u);
    EXPECT_EQ(passes(true, {.edges = 0}), 1u);
    EXPECT_EQ(passes(true, {.frames = 1.0f}), 0u);
}

/// With the default settings, frames that are jittered are averaged.
TEST(Taa, JitteredFramesAreAveragedByDefault) {
    EXPECT_EQ(denoise::framesToAverage({}, false), 1.0f);
    EXPECT_EQ(denoise::framesToAverage({}, true), 2.0f);
    EXPECT_EQ(denoise::framesToAverage({.frames = 1.0f}, true), 1.0f);
    EXPECT_EQ(denoise::framesToAverage({.frames = 4.0f}, false), 4.0f);
}

}  // namespace
}  // namespace limpid::test
