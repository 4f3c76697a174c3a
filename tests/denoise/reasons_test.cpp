// Tests the pass that tells why histories were kept or rejected: against the histories themselves, and with
// known answers.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "denoise/stages/reproject/reasons_params.h"
#include "scene/builtin/builtin.h"
#include "tests/denoise/denoise_fixture.h"
#include "tests/denoise/sequence_fixture.h"
#include "tests/oracle/double_denoise_fixture.h"

namespace limpid::test {
namespace {

using namespace denoise;

constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

/// What the pass tells of a pixel.
struct Reason {
    uint32_t kind = 0;
    bool reflected = false;
    std::array<uint32_t, 4> taps{};
    uint32_t now = 0, whole = 0;  ///< frames, with and without anti-lag

    explicit Reason(const uint32_t* words)
        : kind(words[0] & REASON_MASK),
          reflected((words[0] & REASON_REFLECTED) != 0),
          now(words[1] & REASON_MAX_FRAMES),
          whole(words[1] >> REASON_WHOLE) {
        for (int i = 0; i < 4; ++i)
            taps[static_cast<size_t>(i)] = words[0] >> (REASON_TAPS + REASON_TAP_BITS * i) & REASON_TAP_MASK;
    }
    bool fitsAny() const { return std::ranges::count(taps, uint32_t{TAP_FITS}) > 0; }
};

class ReasonsTest : public DenoiseTest {
  protected:
    /// The reasons of a frame, which follows the last one: of the first signal, or of all.
    std::vector<Reason> reasonsOf(const HostFrame& frame, bool cut = false) {
        graph_.beginFrame();
        DenoiserInput input = denoise::upload(graph_, frame);
        input.filters = filters_;
        input.reasons = {.wanted = true, .cut = cut};
        output_ = findDenoiser(method_)->record(graph_, input, settings_, {});
        graph_.execute(device());
        return reasons(0);
    }
    std::vector<Reason> reasons(size_t signal) {
        const std::vector<uint32_t> words = graph_.downloadUint(device(), output_.reasons.at(signal).image);
        std::vector<Reason> result;
        for (size_t at = 0; at < words.size(); at += 2) result.emplace_back(&words[at]);
        return result;
    }
    /// The length of each pixel's history after the frame, as the denoiser counts it.
    std::vector<dvec4> framesOf(size_t signal) {
        if (method_ != "svgf") return download(output_.frames);
        return download("svgf/reproject " + output_.reasons.at(signal).signal, "moments");
    }

    std::string method_ = "temporal";
    DenoiserSettings settings_;
};

// The pass against the histories of moving frames.

struct Case {
    const char* name;
    const char* method;
    gpu::Backing filters = gpu::Backing::Image;
    bool separate = true, search = true, antilag = false, identity = true;
};

class ReasonsOfFramesTest : public ReasonsTest, public testing::WithParamInterface<Case> {
  protected:
    void SetUp() override {
        ReasonsTest::SetUp();
        const Case& c = GetParam();
        method_ = c.method;
        filters_ = c.filters;
        settings_.svgf.separate = c.separate;
        settings_.svgf.search = settings_.temporal.search = c.search;
        settings_.temporal.identity = c.identity;
        if (!c.antilag) settings_.svgf.antilag = 0.0f;
    }

    double longest() const { return method_ == "svgf" ? 10.0 : double{settings_.temporal.maxHistory}; }

    /// Checks what a pixel's instances, its motion and the depths say without any tolerance.
    static void checkTaps(const HostFrame& frame, const HostFrame& before, size_t p, const Reason& reason,
                          bool identity) {
        const double x = static_cast<double>(p % frame.width) + double{frame.motion[4 * p]},
                     y = static_cast<double>(p / frame.width) + double{frame.motion[4 * p + 1]};
        const auto nearWhole = [](double v) { return std::abs(v - std::round(v)) < 1e-3; };
        if (nearWhole(x) || nearWhole(y)) return;  // rounding decides which pixels are the taps
        for (size_t i = 0; i < 4; ++i) {
            const double column = std::floor(x) + (i & 1 ? 1.0 : 0.0),
                         row = std::floor(y) + (i & 2 ? 1.0 : 0.0);
            const bool outside = column < 0.0 || row < 0.0 || column >= frame.width || row >= frame.height;
            ASSERT_EQ(reason.taps[i] == TAP_OUTSIDE, outside) << p << " " << i;
            if (outside) continue;
            const size_t q = static_cast<size_t>(row) * frame.width + static_cast<size_t>(column);
            const bool seen = before.depth[4 * q + 1] > 0.0f;
            ASSERT_EQ(reason.taps[i] == TAP_NOTHING_SEEN, !seen) << p << " " << i;
            if (!seen) continue;
            const bool other = identity && frame.ids[2 * p] != before.ids[2 * q];
            ASSERT_EQ(reason.taps[i] < TAP_OUTSIDE && (reason.taps[i] & TAP_INSTANCE) != 0, other)
                << p << " " << i;
        }
    }

    /// A history has been kept exactly where a tap fits or one was found nearby, and nowhere else.
    void check(const HostFrame& frame, const Reason& reason, size_t p, double frames) {
        const bool seen = frame.depth[4 * p + 1] > 0.0f;
        ASSERT_EQ(reason.kind == REASON_NOTHING_SEEN, !seen);
        if (!seen) return;
        ASSERT_EQ(reason.now, static_cast<uint32_t>(std::lround(frames)));
        ++count_[reason.kind];
        const bool kept =
            reason.kind == REASON_KEPT || reason.kind == REASON_SEARCHED || reason.kind == REASON_SHORTENED;
        ASSERT_EQ(reason.whole > 0, kept) << reason.kind;
        if (reason.kind >= REASON_REJECTED && reason.kind != REASON_SHORTENED) {
            ASSERT_EQ(reason.fitsAny(), reason.kind == REASON_KEPT) << reason.kind;
        }
        if (!kept) {
            ASSERT_EQ(frames, 1.0) << reason.kind;
            return;
        }
        const auto whole = static_cast<double>(reason.whole);
        ASSERT_GT(whole, 1.9);
        ASSERT_LE(whole, longest());
        if (reason.kind == REASON_SHORTENED) {
            ASSERT_LT(frames, whole + 0.5);
        } else {
            ASSERT_NEAR(frames, whole, 0.51) << reason.kind;
        }
    }

    std::array<size_t, 8> count_{};  ///< pixels of each kind
};

TEST_P(ReasonsOfFramesTest, AreThoseOfTheHistories) {
    const SyntheticScene scene({.cameraMoves = true, .objectMoves = true});
    HostFrame before;
    for (int number = 0; number < 6; ++number) {
        HostFrame frame = scene.frame(number, 101, 57, 7);
        if (number == 4) {  // light that anti-lag cannot miss
            for (float& value : frame.diffuse) value *= 20.0f;
        }
        reasonsOf(frame);
        for (size_t signal = 0; signal < output_.reasons.size(); ++signal) {
            const std::vector<Reason> told = reasons(signal);
            const std::vector<dvec4> frames = framesOf(signal);
            ASSERT_EQ(told.size(), frame.pixelCount());
            for (size_t p = 0; p < told.size(); ++p) {
                check(frame, told[p], p, frames[p].w);
                const bool taps = told[p].kind >= REASON_REJECTED && !told[p].reflected;
                if (taps && number > 0) checkTaps(frame, before, p, told[p], GetParam().identity);
                if (number == 0 && told[p].kind != REASON_NOTHING_SEEN) {
                    ASSERT_EQ(told[p].kind, uint32_t{REASON_CUT});
                }
                if (HasFatalFailure()) FAIL() << "frame " << number << " signal " << signal << " pixel " << p;
            }
        }
        before = std::move(frame);
    }
    EXPECT_GT(count_[REASON_CUT], 1000u);
    EXPECT_GT(count_[REASON_OFF_SCREEN], 50u);
    EXPECT_GT(count_[REASON_REJECTED], 20u);
    EXPECT_GT(count_[REASON_KEPT], 10000u);
    EXPECT_EQ(count_[REASON_SEARCHED] > 0, GetParam().search);
    EXPECT_EQ(count_[REASON_SHORTENED] > 100, GetParam().antilag);
}

INSTANTIATE_TEST_SUITE_P(
    Reasons, ReasonsOfFramesTest,
    testing::Values(Case{"Temporal", "temporal"},
                    Case{.name = "TemporalBuffers",
                         .method = "temporal",
                         .filters = gpu::Backing::Buffer,
                         .search = false,
                         .identity = false},
                    Case{"Atrous", "atrous"}, Case{"Svgf", "svgf"},
                    Case{"SvgfBuffers", "svgf", gpu::Backing::Buffer},
                    Case{.name = "SvgfWithoutSearch", .method = "svgf", .search = false},
                    Case{.name = "SvgfJointAntilag", .method = "svgf", .separate = false, .antilag = true}),
    [](const testing::TestParamInfo<Case>& one) { return std::string(one.param.name); });

// Known answers: a plane of 9x7 pixels, of which one is looked at.

class ReasonsByHandTest : public ReasonsTest, public testing::WithParamInterface<const char*> {
  protected:
    static constexpr size_t columns = 9, rows = 7, middle = 3 * columns + 4;

    void SetUp() override {
        ReasonsTest::SetUp();
        method_ = GetParam();
        settings_.svgf.separate = false;
        settings_.svgf.search = settings_.temporal.search = false;
    }
    static void set(std::vector<float>& layer, size_t p, const std::array<float, 4>& value) {
        std::ranges::copy(value, layer.begin() + static_cast<std::ptrdiff_t>(4 * p));
    }
    /// The pixel's reason in the second frame.
    Reason look(size_t p = middle) {
        reasonsOf(before);
        return reasonsOf(now)[p];
    }
    void expect(const Reason& reason, uint32_t kind, const std::array<uint32_t, 4>& taps) {
        EXPECT_EQ(reason.kind, kind);
        EXPECT_THAT(reason.taps, testing::ElementsAreArray(taps));
    }

    HostFrame before = frontalPlane(columns, rows), now = before;
};

constexpr uint32_t unused = TAP_UNUSED, fits = TAP_FITS;

TEST_P(ReasonsByHandTest, WhatRestsHasOneTap) {
    expect(look(), REASON_KEPT, {fits, unused, unused, unused});
    const Reason third = reasonsOf(now)[middle];
    EXPECT_EQ(third.now, 3u);
    EXPECT_EQ(third.whole, 3u);
}

TEST_P(ReasonsByHandTest, CutsAndResetsHaveNoHistory) {
    EXPECT_EQ(reasonsOf(before)[middle].kind, uint32_t{REASON_CUT});
    EXPECT_EQ(reasonsOf(now)[middle].kind, uint32_t{REASON_KEPT});
    graph_.resetHistories();
    EXPECT_EQ(reasonsOf(now)[middle].kind, uint32_t{REASON_CUT});
    for (size_t p = 0; p < now.pixelCount(); ++p) set(now.motion, p, {0, 0, 0, 0});
    EXPECT_EQ(reasonsOf(now)[middle].kind, uint32_t{REASON_NO_MOTION});
    EXPECT_EQ(reasonsOf(now, true)[middle].kind, uint32_t{REASON_CUT});
    EXPECT_EQ(framesOf(0)[middle].w, 1.0);
}

TEST_P(ReasonsByHandTest, WhereItWas) {
    set(now.motion, middle, {-20, 0, 0, 1});
    expect(look(), REASON_OFF_SCREEN, {fits, fits, fits, fits});  // no taps were looked at
    set(now.motion, middle, {notANumber, 0, 0, 1});
    EXPECT_EQ(look().kind, uint32_t{REASON_NO_MOTION});
    set(now.depth, middle, {0, 0, 0, 0});
    EXPECT_EQ(look().kind, uint32_t{REASON_NOTHING_SEEN});
}

TEST_P(ReasonsByHandTest, TapsBeyondTheEdgeAreOutside) {
    const size_t left = 3 * columns;
    set(now.motion, left, {-0.25f, 0.5f, 0, 1});
    expect(look(left), REASON_KEPT, {TAP_OUTSIDE, fits, TAP_OUTSIDE, fits});
    set(now.motion, left, {-0.75f, 0.5f, 0, 1});
    EXPECT_EQ(look(left).kind, uint32_t{REASON_OFF_SCREEN});
}

TEST_P(ReasonsByHandTest, AnotherSurfaceWasThere) {
    set(now.motion, middle, {0.5f, 0.5f, 0, 1});
    const size_t right = middle + 1, below = middle + columns;
    before.ids[2 * right] = 5;
    set(before.normal, below, {1, 0, 0, 0});
    set(before.depth, below + 1, {2.2f, 1, 0, 0});
    expect(look(), REASON_KEPT, {fits, TAP_INSTANCE, TAP_NORMAL, TAP_DISTANCE});
    set(before.depth, middle, {0, 0, 0, 0});
    expect(look(), REASON_REJECTED, {TAP_NOTHING_SEEN, TAP_INSTANCE, TAP_NORMAL, TAP_DISTANCE});
    set(before.depth, right, {1, 1, 0, 0});
    EXPECT_EQ(look().taps[1], TAP_INSTANCE | TAP_DISTANCE);
    // Within the tolerance of 2 %.
    set(now.depth, middle, {2.19f, 1, 0, 0});
    EXPECT_EQ(look().kind, uint32_t{REASON_KEPT});
}

TEST_P(ReasonsByHandTest, ATapWithoutMuchWeightIsNotEnough) {
    set(now.motion, middle, {0.995f, 0, 0, 1});
    before.ids[2 * (middle + 1)] = 5;
    expect(look(), REASON_REJECTED, {TAP_LIGHT, TAP_INSTANCE, unused, unused});
    EXPECT_EQ(framesOf(0)[middle].w, 1.0);
    set(now.motion, middle, {0.9f, 0, 0, 1});
    expect(look(), REASON_KEPT, {fits, TAP_INSTANCE, unused, unused});
}

TEST_P(ReasonsByHandTest, TheSearchFindsNeighbours) {
    settings_.svgf.search = settings_.temporal.search = true;
    before.ids[2 * middle] = 5;
    expect(look(), REASON_SEARCHED, {TAP_INSTANCE, unused, unused, unused});
    for (uint32_t& id : before.ids) id = 5;
    expect(look(), REASON_REJECTED, {TAP_INSTANCE, unused, unused, unused});
}

TEST_P(ReasonsByHandTest, SamplesThatAreNoNumbersLeaveNoHistory) {
    set(before.diffuse, middle, {notANumber, 1, 1, 0});
    expect(look(), REASON_REJECTED, {TAP_NO_HISTORY, unused, unused, unused});
}

INSTANTIATE_TEST_SUITE_P(Reasons, ReasonsByHandTest, testing::Values("temporal", "svgf"),
                         [](const testing::TestParamInfo<const char*>& one) {
                             return std::string(one.param);
                         });

class LobeReasonsTest : public ReasonsByHandTest {
  protected:
    void SetUp() override {
        ReasonsByHandTest::SetUp();
        settings_.svgf.separate = true;
        for (HostFrame* frame : {&before, &now}) {
            frame->albedoSpecular = frame->albedo;
            frame->reflectionMotion.assign(4 * frame->pixelCount(), 0.0f);
            frame->roughness.assign(4 * frame->pixelCount(), 0.1f);
        }
    }
};

/// A normal that is 11 degrees off passes the test of normals, but not that of a narrow lobe.
TEST_P(LobeReasonsTest, NarrowLobesReflectInAnotherDirection) {
    for (size_t p = 0; p < before.pixelCount(); ++p) set(before.normal, p, {0.19f, 0, 0.98f, 0});
    EXPECT_EQ(look().kind, uint32_t{REASON_KEPT});
    const Reason specular = reasons(1)[middle];
    expect(specular, REASON_REJECTED, {TAP_LOBE, unused, unused, unused});
    EXPECT_FALSE(specular.reflected);
    EXPECT_EQ(framesOf(1)[middle].w, 1.0);
}

/// The reflection is followed first, then the surface.
TEST_P(LobeReasonsTest, ReflectionsAreFollowed) {
    for (size_t p = 0; p < now.pixelCount(); ++p) set(now.reflectionMotion, p, {1, 0, 0, 1});
    set(now.motion, middle, {-20, 0, 0, 1});
    EXPECT_EQ(look().kind, uint32_t{REASON_OFF_SCREEN});
    EXPECT_TRUE(reasons(1)[middle].reflected);
    expect(reasons(1)[middle], REASON_KEPT, {fits, unused, unused, unused});
    before.ids[2 * (middle + 1)] = 5;
    look();
    EXPECT_FALSE(reasons(1)[middle].reflected);
    EXPECT_EQ(reasons(1)[middle].kind, uint32_t{REASON_OFF_SCREEN});
}

INSTANTIATE_TEST_SUITE_P(Reasons, LobeReasonsTest, testing::Values("svgf"));

// A scene of our own: a box that moves in front of a wall.

class ReasonsOfSceneTest : public SequenceTest {};

TEST_F(ReasonsOfSceneTest, TheUncoveredWallWasAnotherObject) {
    load(scene::cornellMovingScene());
    RenderSettings settings = centred(96, 54, 2);
    settings.pipeline = parsePipeline("path", "svgf");
    settings.denoisers.svgf.antilag = 0.0f;
    settings.denoisers.svgf.search = false;
    settings.layers = true;
    FrameRenderer renderer(device(), *gpuScene_, settings, 1);
    renderer.setReasons(true);
    std::vector<uint32_t> idsBefore;
    size_t uncovered = 0;
    for (uint64_t frame = 0; frame < 8; ++frame) {
        renderer.render(sequence_->moment(frame, settings.extent));
        const HistoryReasons told = renderer.historyReasons();
        ASSERT_EQ(told.signals.size(), 2u);
        EXPECT_EQ(told.signals[0].name, "diffuse");
        EXPECT_EQ(told.extent, settings.extent);
        const std::vector<uint32_t> ids = renderer.download().ids;
        const std::vector<float> motion = renderer.motion().pixels;
        for (size_t p = 0; p < settings.extent.width * settings.extent.height; ++p) {
            const Reason reason(&told.signals[0].texels[2 * p]);
            if (frame == 0) {
                ASSERT_EQ(reason.kind, ids[2 * p] == UINT32_MAX ? REASON_NOTHING_SEEN : REASON_CUT);
                continue;
            }
            // The camera rests, so this is where the pixel's point was, if it does not move.
            const bool rests = std::abs(motion[4 * p]) + std::abs(motion[4 * p + 1]) < 1e-6f;
            if (!rests || ids[2 * p] == idsBefore[2 * p] || ids[2 * p] == UINT32_MAX) continue;
            ++uncovered;
            EXPECT_EQ(reason.kind, uint32_t{REASON_REJECTED}) << p;
            EXPECT_NE(reason.taps[0] & TAP_INSTANCE, 0u) << p;
        }
        idsBefore = ids;
    }
    EXPECT_GT(uncovered, 20u);
    renderer.setReasons(false);
    renderer.render(sequence_->moment(8, settings.extent));
    EXPECT_TRUE(renderer.historyReasons().signals.empty());
}

}  // namespace
}  // namespace limpid::test
