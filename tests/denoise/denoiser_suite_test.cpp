// Tests properties that every denoiser must have. A new denoiser is tested automatically once it is in
// denoise::denoisers(). Networks are tested in kpcn_test.cpp.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "image/metrics/metrics.h"
#include "renderer/method/parameters.h"
#include "renderer/method/presets.h"
#include "tests/denoise/denoise_fixture.h"
#include "tests/oracle/double_denoise_fixture.h"

namespace limpid::test {
namespace {

constexpr uint32_t columns = 96, rows = 54;
constexpr int frames = 8;

/// Each is computed once: that takes longer than to denoise it.
const HostFrame& frameOf(const SyntheticScene& scene, int number) {
    static std::map<std::pair<SyntheticOptions, int>, HostFrame> known;
    const auto [place, isNew] = known.try_emplace({scene.options(), number});
    if (isNew) place->second = scene.frame(number, columns, rows, 1);
    return place->second;
}

class DenoiserSuite : public DenoiseTest, public testing::WithParamInterface<std::string> {
  protected:
    static const denoise::Denoiser& method() { return *denoise::findDenoiser(GetParam()); }

    /// A network behind SVGF.
    static bool isOnSvgf() { return method().name == "nano" || method().name == "film"; }

    /// Returns the last picture of a sequence, starting with empty histories.
    std::vector<float> denoiseSequence(const SyntheticScene& scene, const DenoiserSettings& settings = {},
                                       int count = frames) {
        graph_.beginFrame();
        graph_.resetHistories();
        std::vector<float> picture;
        for (int number = 0; number < count; ++number) {
            HostFrame frame = frameOf(scene, number);
            frame.jitter = jitter_;
            if (samples_ > 1) addVariances(frame, samples_);
            picture = denoise(method(), frame, settings);
        }
        return picture;
    }

    static image::Image rgbOf(const std::vector<float>& texels) {
        image::Image picture(columns, rows, 3);
        for (size_t p = 0; p < size_t{columns} * rows; ++p) {
            for (size_t c = 0; c < 3; ++c) picture.pixels[3 * p + c] = texels[4 * p + c];
        }
        return picture;
    }

    static double psnrOf(const std::vector<float>& picture, const std::vector<float>& truth) {
        return image::psnr(image::displayEncode(rgbOf(picture), 0.0f),
                           image::displayEncode(rgbOf(truth), 0.0f));
    }

    std::optional<vec2> jitter_;  ///< of every frame of a sequence
    uint32_t samples_ = 1;        ///< with variances, if there are more
};

/// What filters light, and not only one channel (visibility_test.cpp).
class ColorDenoiserSuite : public DenoiserSuite {};

const SyntheticOptions moving{.cameraMoves = true, .objectMoves = true};

void expectFinite(const std::vector<float>& picture) {
    for (size_t i = 0; i < picture.size(); ++i) ASSERT_TRUE(std::isfinite(picture[i])) << i;
}

TEST_P(ColorDenoiserSuite, AConstantImageStaysConstant) {
    HostFrame frame = frontalPlane(columns, rows);
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        for (size_t c = 0; c < 3; ++c) frame.diffuse[4 * p + c] = 0.25f * static_cast<float>(c + 1);
    }
    for (int number = 0; number < frames; ++number) {
        const std::vector<float> picture = denoise(method(), frame);
        for (size_t i = 0; i < picture.size(); ++i) {
            const float expected = i % 4 == 3 ? 1.0f : 0.25f * static_cast<float>(i % 4 + 1);
            ASSERT_NEAR(picture[i], expected, 1e-3f) << "frame " << number << " pixel " << i / 4;
        }
    }
}

/// Other renderers give the sky's light as they give that of surfaces. Its albedo is 0.
TEST_P(ColorDenoiserSuite, BrightSkiesStay) {
    HostFrame frame = frontalPlane(columns, rows);
    constexpr float sky = 5000.0f;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const bool isSky = p < frame.pixelCount() / 2;
        for (size_t c = 0; c < 3; ++c) {
            frame.diffuse[4 * p + c] = isSky ? sky : 0.25f;
            if (!isSky) continue;
            frame.albedo[4 * p + c] = 0.0f;
            frame.depth[4 * p + c] = 0.0f;
        }
    }
    for (int number = 0; number < 3; ++number) {
        const std::vector<float> picture = denoise(method(), frame);
        for (size_t i = 0; i < picture.size(); ++i) {
            if (i % 4 == 3) continue;
            const float expected = frame.diffuse[i];
            ASSERT_NEAR(picture[i], expected, 1e-3f * expected) << "frame " << number << " pixel " << i / 4;
        }
    }
}

TEST_P(ColorDenoiserSuite, TexturesUnderConstantLightStaySharp) {
    const SyntheticScene scene({.cameraMoves = true});
    for (int number = 0; number < frames; ++number) {
        HostFrame frame = frameOf(scene, number);
        std::fill(frame.specular.begin(), frame.specular.end(), 0.0f);
        for (size_t i = 0; i < frame.albedo.size(); ++i) {
            frame.albedo[i] = std::max(frame.albedo[i], 0.1f);  // no method's minimum counts
            frame.diffuse[i] = frame.depth[i / 4 * 4 + 1] > 0.0f ? frame.albedo[i] : 0.0f;
        }
        const std::vector<float> picture = denoise(method(), frame);
        for (size_t i = 0; i < picture.size(); ++i) {
            if (i % 4 == 3) continue;
            const float expected = frame.diffuse[i] + frame.emission[i];
            ASSERT_NEAR(picture[i], expected, 2e-3f * expected + 1e-6f) << "frame " << number << " " << i / 4;
        }
    }
}

TEST_P(DenoiserSuite, NoNanGoesInOrComesOut) {
    const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                         -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::max()};
    const SyntheticScene scene(moving);
    const float expected = medianOf(denoiseSequence(scene));
    graph_.beginFrame();
    graph_.resetHistories();
    std::vector<float> picture;
    for (int number = 0; number < frames; ++number) {
        HostFrame frame = frameOf(scene, number);
        size_t at = 5 + static_cast<size_t>(number);
        for (const LayerInfo& layer : frameLayers) {
            if (!layer.isMean()) continue;
            std::vector<float>& pixels = frame[layer];
            for (const float value : bad) {
                if (&pixels == &frame.emission && value == bad[3]) continue;  // emission is not filtered
                pixels[at % pixels.size()] = value;
                at += 617;
            }
        }
        picture = denoise(method(), frame);
        expectFinite(picture);
        if (HasFatalFailure()) return;
    }
    ASSERT_GT(expected, 0.0f);
    EXPECT_NEAR(medianOf(picture), expected, 0.25f * expected) << "the rest of the picture stays";
}

TEST_P(DenoiserSuite, AnySizeWorks) {
    const SyntheticScene scene(moving);
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, {1u, 9u}, {9u, 1u}, {2u, 3u}, {17u, 5u}, {33u, 65u}}) {
        for (int number = 0; number < 3; ++number) {
            const std::vector<float> picture = denoise(method(), scene.frame(number, width, height, 1));
            ASSERT_EQ(picture.size(), size_t{4} * width * height);
            expectFinite(picture);
        }
    }
}

TEST_P(DenoiserSuite, ResizeAndResetStartAnew) {
    const SyntheticScene scene(moving);
    const std::vector<float> fresh = denoiseSequence(scene);
    denoise(method(), scene.frame(3, 40, 30, 1));
    std::vector<float> picture;
    for (int number = 0; number < frames; ++number) picture = denoise(method(), frameOf(scene, number));
    EXPECT_EQ(picture, fresh) << "after a resize";
    EXPECT_EQ(denoiseSequence(scene), fresh) << "after a reset; and the same input gives the same bits";
}

/// Returns both ends of a parameter's range, and a value in between.
std::vector<std::string> numbersOf(const ParamInfo& info) {
    if (!std::holds_alternative<int>(info.defaultValue)) {
        const double between = std::min(std::ceil(info.minimum) + 1.0, 0.5 * (info.minimum + info.maximum));
        return {fmt::format("{}", info.minimum), fmt::format("{}", between), fmt::format("{}", info.maximum)};
    }
    const int min = static_cast<int>(info.minimum), max = static_cast<int>(info.maximum);
    return {std::to_string(min), std::to_string(std::min(min + 1, max)), std::to_string(max)};
}

/// Returns the settings that are required for a parameter to have an effect.
std::vector<std::string> neededFor(const std::string& parameter) {
    if (parameter == "temporal.grey" || parameter == "temporal.grey_misses")
        return {"temporal.grey_restart=on"};
    if (parameter == "temporal.identity") return {"temporal.depth=1e6", "temporal.normal=-1"};
    return {};
}

/// Most parameters matter at once; changes of light are found where there is some history.
int framesFor(const std::string& parameter) {
    return parameter.starts_with("svgf.antilag") ? frames : 4;
}

TEST_P(DenoiserSuite, EveryParameterMatters) {
    const SyntheticScene scene(moving), still({});
    jitter_ = vec2(0.2f, -0.1f);
    const std::vector<float> defaults = denoiseSequence(scene, {}, framesFor(""));
    for (const ParamGroup& group : paramGroups()) {
        if (std::ranges::find(method().groups, group.name) == method().groups.end()) continue;
        if (isOnSvgf() && group.name == "svgf") continue;  // the same passes as SVGF's own
        for (const ParamInfo& info : group.infos) {
            const bool flag = std::holds_alternative<bool>(info.defaultValue);
            const std::vector<std::string> values =
                flag ? std::vector<std::string>{std::get<bool>(info.defaultValue) ? "off" : "on"}
                     : numbersOf(info);
            RenderSettings beside;
            const std::string name = group.name + "." + info.name;
            const std::vector<std::string> needed = neededFor(name);
            for (const std::string& text : needed) assign(beside, text);
            const bool rests = name == "taa.still_frames";
            const SyntheticScene& seen = rests ? still : scene;
            samples_ = name == "svgf.sample_variance" ? 4 : 1;
            const int count = framesFor(name);
            const bool asUsual = needed.empty() && !rests && samples_ == 1 && count == framesFor("");
            const std::vector<float> plain =
                asUsual ? defaults : denoiseSequence(seen, beside.denoisers, count);
            bool matters = false;
            for (const std::string& value : values) {
                RenderSettings settings = beside;
                assign(settings, name + "=" + value);
                const std::vector<float> picture = denoiseSequence(seen, settings.denoisers, count);
                SCOPED_TRACE(name + "=" + value);
                expectFinite(picture);
                matters = matters || picture != plain;
            }
            EXPECT_TRUE(matters) << name;
        }
    }
}

TEST_P(ColorDenoiserSuite, EveryPresetIsAnotherPicture) {
    const SyntheticScene scene(moving);
    const std::vector<float> plain = denoiseSequence(scene);
    for (const Preset& preset : presets()) {
        if (!preset.isFor(parsePipeline("path", GetParam()))) continue;
        RenderSettings settings;
        applyPreset(settings, preset.name);
        const std::vector<float> picture = denoiseSequence(scene, settings.denoisers);
        expectFinite(picture);
        EXPECT_NE(picture, plain) << preset.name;
    }
}

/// PSNR gain in dB over the noisy frames, after 24 frames.
constexpr double minGain = 8.0;

TEST_P(ColorDenoiserSuite, ThePictureIsNearerToTheTruthThanTheInput) {
    for (const SyntheticOptions& options : {SyntheticOptions{}, moving}) {
        const SyntheticScene scene(options);
        const int count = 24;
        const std::vector<float> picture = denoiseSequence(scene, {}, count);
        const HostFrame& last = frameOf(scene, count - 1);
        std::vector<float> noisy(picture.size(), 1.0f);
        for (size_t i = 0; i < noisy.size(); ++i)
            noisy[i] = last.diffuse[i] + last.specular[i] + last.emission[i];
        const std::vector<float> truth = scene.truth(count - 1, columns, rows);
        const double gain = psnrOf(picture, truth) - psnrOf(noisy, truth);
        RecordProperty(options.cameraMoves ? "gain_moving_dB" : "gain_still_dB", std::to_string(gain));
        EXPECT_GE(gain, minGain) << (options.cameraMoves ? "moving" : "still");
    }
}

TEST_P(DenoiserSuite, ImagesAndBuffersGiveTheSamePicture) {
    const SyntheticScene scene(moving);
    const std::vector<float> images = denoiseSequence(scene);
    filters_ = gpu::Backing::Buffer;
    const std::vector<float> buffers = denoiseSequence(scene);
    // The networks amplify the rounding of halves, in few pixels to more than 0.003.
    const float most = isOnSvgf() ? 1e-2f : 3e-3f;
    size_t large = 0;
    for (size_t i = 0; i < images.size(); ++i) {
        ASSERT_NEAR(buffers[i], images[i], most * std::abs(images[i]) + 1e-6f) << i;
        if (std::abs(buffers[i] - images[i]) > 3e-3f * std::abs(images[i]) + 1e-6f) ++large;
    }
    EXPECT_LE(large, images.size() / 1000);
}

std::vector<std::string> names(bool colorsOnly) {
    std::vector<std::string> result;
    for (const denoise::Denoiser& denoiser : denoise::denoisers()) {
        if (denoiser.network || (colorsOnly && denoiser.oneChannel)) continue;  // kpcn_test.cpp
        result.emplace_back(denoiser.name);
    }
    return result;
}

std::string nameOf(const testing::TestParamInfo<std::string>& info) {
    return info.param;
}

INSTANTIATE_TEST_SUITE_P(Denoisers, DenoiserSuite, testing::ValuesIn(names(false)), nameOf);
INSTANTIATE_TEST_SUITE_P(Denoisers, ColorDenoiserSuite, testing::ValuesIn(names(true)), nameOf);

}  // namespace
}  // namespace limpid::test
