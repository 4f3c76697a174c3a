// Compares every pass of the a-trous filter with the version in double precision, on identical inputs.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/denoise/denoise_fixture.h"
#include "tests/oracle/double_denoise_fixture.h"

namespace limpid::test {
namespace {

struct Case {
    const char* name;
    SyntheticOptions options;
    bool plane = true;
    float normalFactor = 0.003f, depthFactor = 1e-4f, sampleTarget = 32.0f;
    uint32_t columns = 131, rows = 77;
    float minAlbedo = 0.1f;
    float colorFactor = 0.0f;
};

std::string nameOf(const testing::TestParamInfo<std::tuple<Case, gpu::Backing>>& info) {
    return std::get<0>(info.param).name +
           std::string(std::get<1>(info.param) == gpu::Backing::Image ? "Images" : "Buffers");
}

/// The tolerance of half precision: 1e-3 of the value; the smallest half is 6e-8.
void expectNear(const std::vector<dvec4>& values, const std::vector<dvec4>& expected, double relative,
                const std::string& what) {
    ASSERT_EQ(values.size(), expected.size()) << what;
    for (size_t p = 0; p < values.size(); ++p) {
        for (int c = 0; c < 4; ++c) {
            const double e = expected[p][c];
            ASSERT_NEAR(values[p][c], e, relative * std::abs(e) + 1e-7)
                << what << " pixel " << p << " of " << c;
        }
    }
}

class AtrousPassTest : public DenoiseTest,
                       public testing::WithParamInterface<std::tuple<Case, gpu::Backing>> {
  protected:
    void SetUp() override {
        DenoiseTest::SetUp();
        filters_ = std::get<1>(GetParam());
    }

    std::vector<dvec4> demodulated(const HostFrame& frame, const DoubleAtrousParams& params,
                                   AtrousGeometry& geometry) {
        const std::vector<dvec4> light = download("atrous/demodulate", "demodulated");
        geometry = decodeGeometry(graph_.downloadUint(device(), written("atrous/demodulate", "geometry")));
        const Demodulated expected = demodulate(frame, scatteredLight(frame), params);
        expectNear(light, expected.light, 1e-3, "demodulated");
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            const double d = expected.geometry.distance[p];
            EXPECT_NEAR(geometry.distance[p], d, 1e-5 * d) << p;
            if (d <= 0.0) continue;
            EXPECT_LT(glm::distance(geometry.normal[p], expected.geometry.normal[p]), 1e-4) << p;
        }
        return light;
    }
};

TEST_P(AtrousPassTest, EveryPassAgreesWithTheFormulasInDouble) {
    const Case& c = std::get<0>(GetParam());
    const SyntheticScene scene(c.options);
    const HostFrame frame = scene.frame(5, c.columns, c.rows, 3);
    DenoiserSettings settings;
    settings.atrous = {.temporal = false,
                       .levels = 5,
                       .normalFactor = c.normalFactor,
                       .depthFactor = c.depthFactor,
                       .sampleTarget = c.sampleTarget,
                       .plane = c.plane,
                       .demodulate = c.minAlbedo > 0.0f,
                       .minAlbedo = std::max(c.minAlbedo, 0.001f),
                       .colorFactor = c.colorFactor};
    denoise(*denoise::findDenoiser("atrous"), frame, settings);
    const DoubleAtrousParams params{.levels = 5,
                                    .normalFactor = double{c.normalFactor},
                                    .depthFactor = double{c.depthFactor},
                                    .sampleTarget = double{c.sampleTarget},
                                    .plane = c.plane,
                                    .minAlbedo = double{c.minAlbedo},
                                    .colorFactor = double{c.colorFactor}};
    AtrousGeometry geometry;
    std::vector<dvec4> light = demodulated(frame, params, geometry);
    for (uint32_t i = 0; i < 5; ++i) {
        const std::string pass = "atrous/level " + std::to_string(i + 1);
        const std::vector<dvec4> expected = level(frame, light, geometry, i, params);
        light = download(pass, pass);
        expectNear(light, expected, 1e-3, pass);
        if (HasFatalFailure()) return;
    }
    expectNear(download(output_.beauty), modulate(frame, light, params), 1e-5, "modulated");
}

INSTANTIATE_TEST_SUITE_P(
    Cases, AtrousPassTest,
    testing::Combine(
        testing::Values(Case{"Default", {}}, Case{"Moved", {.cameraMoves = true, .objectMoves = true}},
                        Case{"Wide", {}, true, 10.0f, 1.0f, 1.0f},
                        Case{"Orthographic", {.orthographic = true}}, Case{"Scaled", {.scale = 1024}},
                        Case{"Course", {}, false, 0.003f, 0.007f, 0.0f},
                        Case{"OrthographicCourse", {.orthographic = true}, false, 0.003f, 0.007f},
                        Case{.name = "Modulated", .options = {}, .minAlbedo = 0.0f},
                        Case{.name = "DarkAlbedo", .options = {}, .minAlbedo = 0.02f},
                        Case{.name = "Color", .options = {.cameraMoves = true}, .colorFactor = 0.5f},
                        Case{"ColorModulated", {}, true, 10.0f, 1.0f, 0.0f, 131, 77, 0.0f, 20.0f},
                        Case{"Tiny", {}, true, 0.003f, 1e-4f, 32.0f, 3, 2},
                        Case{"Thin", {}, true, 0.003f, 1e-4f, 32.0f, 1, 40}),
        testing::Values(gpu::Backing::Image, gpu::Backing::Buffer)),
    nameOf);

class AtrousTest : public DenoiseTest {};

/// Also in the first frame.
TEST_F(AtrousTest, SamplesThatAreNoNumbersDarkenNothing) {
    HostFrame frame = frontalPlane(64, 36);
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const float light = p % 7 == 3 ? std::numeric_limits<float>::quiet_NaN() : 0.5f;
        for (size_t c = 0; c < 3; ++c) frame.diffuse[4 * p + c] = light;
    }
    for (const bool temporal : {false, true}) {
        DenoiserSettings settings;
        settings.atrous.temporal = temporal;
        const std::vector<float> picture = denoise(*denoise::findDenoiser("atrous"), frame, settings);
        for (size_t i = 0; i < picture.size(); ++i) {
            if (i % 4 == 3) continue;
            ASSERT_NEAR(picture[i], 0.5f, 1e-3f) << "pixel " << i / 4 << " temporal " << temporal;
        }
    }
}

/// Rounding must not make weights of more than 1.
TEST_F(AtrousTest, NormalsMayHaveNoToleranceAtAll) {
    const HostFrame frame = SyntheticScene({}).frame(0, 64, 36, 1);
    DenoiserSettings settings;
    settings.atrous = {.temporal = false, .normalFactor = 1e-9f};
    const std::vector<float> picture = denoise(*denoise::findDenoiser("atrous"), frame, settings);
    const float brightest = *std::ranges::max_element(frame.diffuse) +
                            *std::ranges::max_element(frame.specular) +
                            *std::ranges::max_element(frame.emission);
    for (size_t i = 0; i < picture.size(); ++i) {
        ASSERT_TRUE(std::isfinite(picture[i])) << i / 4;
        if (i % 4 == 3) continue;
        ASSERT_LE(picture[i], brightest) << i / 4;
    }
}

TEST_F(AtrousTest, LevelsAreAsManyAsAskedForAndNoneLeavesThePicture) {
    const HostFrame frame = SyntheticScene({}).frame(0, 64, 36, 1);
    DenoiserSettings settings;
    settings.atrous.temporal = false;
    settings.atrous.levels = 0;
    const std::vector<float> picture = denoise(*denoise::findDenoiser("atrous"), frame, settings);
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        for (size_t c = 0; c < 3; ++c) {
            const float noisy =
                frame.diffuse[4 * p + c] + frame.specular[4 * p + c] + frame.emission[4 * p + c];
            ASSERT_NEAR(picture[4 * p + c], noisy, 1e-3f * noisy + 1e-7f);
        }
    }
    settings.atrous.levels = 7;
    denoise(*denoise::findDenoiser("atrous"), frame, settings);
    EXPECT_EQ(graph_.passes().size(), 9u) << "demodulate, seven levels, compose";
}

}  // namespace
}  // namespace limpid::test
