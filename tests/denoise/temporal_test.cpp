// Compares the pass of temporal accumulation with the version in double precision, on identical inputs.
#include <gmock/gmock.h>

#include <sstream>

#include "base/params.h"
#include "renderer/method/presets.h"
#include "tests/denoise/denoise_fixture.h"
#include "tests/oracle/svgf/double_svgf.h"

namespace limpid::test {
namespace {

constexpr uint32_t columns = 213, rows = 119;

DoubleTemporalParams inDouble(const denoise::TemporalSettings& s) {
    return {.normal = double{s.normal},
            .depth = double{s.depth},
            .relative = s.relative,
            .search = s.search,
            .minAlbedo = s.demodulate ? double{s.minAlbedo} : 0.0,
            .maxHistory = static_cast<uint32_t>(s.maxHistory),
            .greyRestart = s.greyRestart,
            .grey = double{s.grey},
            .greyMisses = s.greyMisses,
            .identity = s.identity};
}

/// True if float32's errors of the position and of the numbers do not explain the difference.
bool differs(const dvec4& value, const dvec4& expected, const dvec4& slope) {
    for (int c = 0; c < 4; ++c) {
        const double tolerance = 1e-4 * slope[c] + 1e-5 * (1.0 + std::abs(expected[c]));
        if (!(std::abs(value[c] - expected[c]) <= tolerance)) return true;
    }
    return false;
}

/// Normals are stored with 12 bits per octahedral coordinate, distances with 13 of mantissa.
bool surfaceDiffers(const dvec4& value, const dvec4& expected) {
    const bool seen = expected.w > 0.0;
    return std::abs(value.w - expected.w) > 0x1.01p-14 * expected.w ||
           (seen && glm::distance(dvec3(value), dvec3(expected)) > 1.05e-3);
}

struct Sequence {
    const char* name;
    SyntheticOptions options;
    const char* parameters;  ///< "name=value" of the group temporal, separated by blanks
    int resizeAt = -1;       ///< from this frame on the picture is smaller
    gpu::Backing filters = gpu::Backing::Image;
};

std::string nameOf(const testing::TestParamInfo<Sequence>& info) {
    return info.param.name;
}

class TemporalPassTest : public DenoiseTest, public testing::WithParamInterface<Sequence> {
  protected:
    void SetUp() override {
        DenoiseTest::SetUp();
        filters_ = GetParam().filters;
    }

    static denoise::TemporalSettings settings() {
        denoise::TemporalSettings result;
        std::istringstream words(GetParam().parameters);
        for (std::string word; words >> word;) {
            const size_t equals = word.find('=');
            if (equals == std::string::npos) {
                RenderSettings all;
                applyPreset(all, word);
                result = all.denoisers.temporal;
            } else {
                EXPECT_TRUE(
                    denoise::temporal::params().set(result, word.substr(0, equals), word.substr(equals + 1)));
            }
        }
        return result;
    }

    /// Compares a frame on the device with the double version, starting from the device's previous state.
    void compare(const HostFrame& frame, const TemporalImages& before, const denoise::TemporalSettings& s,
                 int number) {
        const TemporalResult expected = accumulateTemporally(frame, before, inDouble(s));
        const TemporalImages now = images(frame, inDouble(s).minAlbedo);
        const std::vector<uint32_t> disocclusion = graph_.downloadUint(device(), output_.disocclusion);
        size_t doubtful = 0, wrong = 0;
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            const TemporalPixel& pixel = expected.pixels[p];
            doubtful += pixel.doubtful;
            if (pixel.doubtful) continue;
            ASSERT_EQ(disocclusion[p] & denoise::DISOCCLUSION_MASK, static_cast<uint32_t>(pixel.failure))
                << "frame " << number << " pixel " << p;
            ASSERT_EQ((disocclusion[p] & denoise::SAMPLE_REJECTED) != 0, pixel.rejected);
            wrong += differs(now.colour[p], expected.images.colour[p], pixel.slope) ||
                     surfaceDiffers(now.normalDepth[p], expected.images.normalDepth[p]) ||
                     differs(now.albedoId[p], expected.images.albedoId[p], dvec4(0.0));
        }
        // If rounding moves a position across a pixel's centre, other taps are used, which the slope does not
        // include.
        EXPECT_LE(wrong, frame.pixelCount() / 1000) << "frame " << number;
        EXPECT_LE(doubtful, frame.pixelCount() / 1000) << "frame " << number;
        counts_ = denoise::countDisocclusion(disocclusion);
    }

    /// What the oracle calls the history: the device stores light without albedo.
    TemporalImages images(const HostFrame& frame, double minAlbedo) {
        TemporalImages images{frame.width, frame.height, download("temporal/accumulate", "color"), {}, {}};
        const DoubleFrame pixels(frame);
        const SvgfSurfaces surfaces =
            decodeSurfaces(graph_.downloadUint(device(), written("surfaces", "surfaces")));
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            images.normalDepth.emplace_back(surfaces.normal[p], surfaces.distance[p]);
            images.albedoId.emplace_back(pixels.albedo(p), surfaces.id[p]);
            const dvec3 factor = modulation(pixels.albedo(p), minAlbedo);
            images.colour[p] *= dvec4(factor, 1.0);
        }
        return images;
    }

    denoise::DisocclusionCounts counts_;
};

TEST_P(TemporalPassTest, AgreesWithTheFormulasInDouble) {
    const Sequence& sequence = GetParam();
    const SyntheticScene scene(sequence.options);
    const denoise::TemporalSettings s = settings();
    TemporalImages before;
    for (int number = 0; number < 8; ++number) {
        const bool small = sequence.resizeAt >= 0 && number >= sequence.resizeAt;
        const HostFrame frame = scene.frame(number, small ? 101 : columns, small ? 67 : rows, 7);
        DenoiserSettings all;
        all.temporal = s;
        denoise(*denoise::findDenoiser("temporal"), frame, all);
        compare(frame, before, s, number);
        if (testing::Test::HasFatalFailure()) return;
        before = images(frame, inDouble(s).minAlbedo);
    }
    if (!sequence.options.orthographic) {
        EXPECT_GT(counts_.nothingHit, 0u) << "the sky";
    }
    if (sequence.options.cameraMoves) {
        EXPECT_GT(counts_.offScreen, 0u);
    }
    if (sequence.options.objectMoves) {
        EXPECT_GT(counts_.noValidTap, 0u) << "what the object uncovers";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Sequences, TemporalPassTest,
    testing::Values(
        Sequence{"Static", {}, ""}, Sequence{"StaticUnlimited", {}, "max_history=0"},
        Sequence{"Camera", {.cameraMoves = true}, ""},
        Sequence{"CameraOrthographic", {.cameraMoves = true, .orthographic = true}, ""},
        Sequence{"Object", {.objectMoves = true}, ""},
        Sequence{"Both", {.cameraMoves = true, .objectMoves = true}, "max_history=4"},
        Sequence{"Resize", {.cameraMoves = true}, "", 4},
        Sequence{"LargeScale", {.cameraMoves = true, .objectMoves = true, .scale = 1024}, ""},
        Sequence{"NoSearch", {.cameraMoves = true, .objectMoves = true}, "search=off"},
        Sequence{"Modulated", {.cameraMoves = true}, "demodulate=off"},
        Sequence{"DarkAlbedo", {.cameraMoves = true}, "min_albedo=0.1"},
        Sequence{"Buffers", {.cameraMoves = true, .objectMoves = true}, "", -1, gpu::Backing::Buffer},
        Sequence{"Grey", {.cameraMoves = true}, "grey_restart=on grey=0.1 grey_misses=on"},
        Sequence{"AnyObject", {.cameraMoves = true, .objectMoves = true}, "identity=off depth=0.3 normal=-1"},
        Sequence{"Course", {.cameraMoves = true, .objectMoves = true}, "history-tracking-course"}),
    nameOf);

class TemporalTest : public DenoiseTest {};

TEST_F(TemporalTest, RejectedSamplesAreCountedAndLeaveTheHistoryAlone) {
    const SyntheticScene scene({});
    const denoise::Denoiser& method = *denoise::findDenoiser("temporal");
    denoise(method, scene.frame(0, 32, 18, 1));
    denoise(method, scene.frame(1, 32, 18, 1));
    const std::vector<dvec4> before = download("temporal/accumulate", "color");
    HostFrame frame = scene.frame(2, 32, 18, 1);
    frame.diffuse[4 * 300] = std::numeric_limits<float>::quiet_NaN();
    frame.specular[4 * 500 + 2] = std::numeric_limits<float>::infinity();
    denoise(method, frame);
    const std::vector<dvec4> after = download("temporal/accumulate", "color");
    // Dividing by the albedo and multiplying again may change the last bit.
    EXPECT_LT(glm::distance(after[300], before[300]), 1e-6);
    EXPECT_LT(glm::distance(after[500], before[500]), 1e-6);
    EXPECT_NE(after[301], before[301]);
    EXPECT_EQ(denoise::countDisocclusion(graph_.downloadUint(device(), output_.disocclusion)).rejected, 2u);
}

TEST_F(TemporalTest, AHistoryBelowOneFrameCountsAsOne) {
    const SyntheticScene scene({});
    std::vector<std::vector<float>> pictures;
    for (const float longest : {0.25f, 1.0f}) {
        DenoiserSettings settings;
        settings.temporal.maxHistory = longest;
        graph_.resetHistories();
        for (int number = 0; number < 3; ++number)
            denoise(*denoise::findDenoiser("temporal"), scene.frame(number, 32, 18, 1), settings);
        pictures.push_back(graph_.downloadFloat(device(), output_.beauty));
    }
    EXPECT_EQ(pictures[0], pictures[1]);
}

TEST_F(TemporalTest, DisocclusionIsShownInColours) {
    const SyntheticScene scene({.cameraMoves = true, .objectMoves = true});
    DenoiserSettings settings;
    settings.temporal.showDisocclusion = true;
    std::vector<float> picture;
    for (int number = 0; number < 3; ++number)
        picture = denoise(*denoise::findDenoiser("temporal"), scene.frame(number, 64, 36, 1), settings);
    const std::vector<uint32_t> disocclusion = graph_.downloadUint(device(), output_.disocclusion);
    const vec3 colors[] = {{}, {0, 0, 1}, {1, 1, 0}, {1, 0, 0}};
    for (size_t p = 0; p < disocclusion.size(); ++p) {
        const vec3 shown{picture[4 * p], picture[4 * p + 1], picture[4 * p + 2]};
        if (disocclusion[p] == denoise::DISOCCLUSION_NONE) {
            ASSERT_EQ(shown.x, shown.z) << "grey";
        } else {
            ASSERT_EQ(shown, colors[disocclusion[p]]);
        }
    }
}

}  // namespace
}  // namespace limpid::test
