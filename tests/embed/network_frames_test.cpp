// Tests the network's C interface: it gives the same picture as the internal denoiser, uses the documented
// defaults for missing inputs, and refuses invalid arguments.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

#include "denoise/api/denoiser.h"
#include "image/io/temp_folder.h"
#include "limpid/neural.h"
#include "tests/denoise/denoise_fixture.h"

namespace limpid::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

constexpr uint32_t width = 41, height = 23, samples = 9;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

std::string smallWeights() {
    return std::string(LIMPID_SOURCE_DIR) + "/tests/data/kpcn_small.safetensors";
}

/// A synthetic frame, as the C interface takes it and as the internal denoisers do.
struct GivenFrame {
    HostFrame frame;  ///< for the internal denoisers
    std::array<std::vector<float>, 5> variances;
    std::vector<float> depths, clean;
    limpid_network_frame given{};

    GivenFrame(uint32_t wide, uint32_t high) : frame(SyntheticScene({}).frame(1, wide, high, 1)) {
        frame.samples = samples;
        takeDistances();
        takeVariances();
        given.size = sizeof given;
        given.width = wide;
        given.height = high;
        given.samples = samples;
        giveImages();
        clean.assign(4 * frame.pixelCount(), -1.0f);
        given.color = {clean.data(), 4, 0, 0};
    }
    GivenFrame(const GivenFrame&) = delete;
    GivenFrame& operator=(const GivenFrame&) = delete;

    limpid_host_image& input(limpid_network_input which) { return given.inputs[which]; }

  private:
    void takeDistances() {
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            float* const depth = &frame.depth[4 * p];
            depths.push_back(depth[1] > 0.0f ? depth[0] / depth[1] : 0.0f);
            depth[0] = depths.back();
            depth[1] = depth[0] > 0.0f ? 1.0f : 0.0f;
        }
    }
    void takeVariances() {
        std::mt19937 generator(3);
        std::uniform_real_distribution<float> uniform(0.0f, 0.01f);
        std::vector<float>* const layers[] = {&frame.diffuse, &frame.specular, &frame.albedo, &frame.normal,
                                              &frame.depth};
        for (size_t layer = 0; layer < variances.size(); ++layer) {
            for (size_t p = 0; p < frame.pixelCount(); ++p) {
                variances[layer].push_back(uniform(generator));
                (*layers[layer])[4 * p + 3] = variances[layer].back() * static_cast<float>(samples - 1);
            }
        }
    }
    void giveImages() {
        const std::vector<float>* const images[] = {&frame.diffuse, &frame.specular, &frame.emission,
                                                    &frame.albedo, &frame.normal};
        for (size_t i = 0; i < std::size(images); ++i)
            given.inputs[i] = {images[i]->data(), 3, 4 * sizeof(float), 0};
        input(LIMPID_NETWORK_INPUT_DEPTH) = {depths.data(), 1, 0, 0};
        for (size_t i = 0; i < variances.size(); ++i)
            given.inputs[LIMPID_NETWORK_INPUT_DIFFUSE_VARIANCE + i] = {variances[i].data(), 1, 0, 0};
    }
};

class NetworkFramesTest : public DenoiseTest {
  protected:
    void SetUp() override {
        DenoiseTest::SetUp();
        if (IsSkipped() || network_) return;
        network_ = open(smallWeights());
        ASSERT_NE(network_, nullptr);
    }
    static void TearDownTestSuite() { limpid_network_destroy(std::exchange(network_, nullptr)); }

    static limpid_network* open(const std::string& weights) {
        const std::string select = wantedDevice();
        limpid_device_desc device = {sizeof device};
        device.select = select.c_str();
        device.message = [](void*, limpid_message_level, const char* text) { told_.emplace_back(text); };
        limpid_network_desc desc = {sizeof desc};
        desc.weights = weights.c_str();
        limpid_network* network = nullptr;
        EXPECT_EQ(limpid_network_create(&device, &desc, &network), LIMPID_OK) << limpid_network_last_error();
        return network;
    }
    std::vector<float> inside(const HostFrame& frame, const DenoiserSettings& settings = {}) {
        networks_.kpcn = std::make_shared<denoise::KpcnNetwork>(
            device(), denoise::readKpcnWeights(smallWeights()),
            denoise::kpcnPrecision(device().info(), settings.kpcn.half));
        return denoise(*denoise::findDenoiser("kpcn"), frame, settings);
    }
    void expectRefused(const limpid_network_frame& frame, const std::string& why) {
        EXPECT_EQ(limpid_network_denoise(network_, &frame), LIMPID_ERROR_INVALID_ARGUMENT) << why;
        EXPECT_THAT(limpid_network_last_error(), HasSubstr(why));
    }

    inline static limpid_network* network_ =
        nullptr;  ///< shared by all tests, so that each shader is compiled once
    inline static std::vector<std::string> told_;
};

TEST_F(NetworkFramesTest, IsWhatTheDenoiserComputes) {
    for (const auto& [wide, high] : {std::pair{width, height}, {13u, 30u}}) {
        GivenFrame frame(wide, high);
        ASSERT_EQ(limpid_network_denoise(network_, &frame.given), LIMPID_OK) << limpid_network_last_error();
        EXPECT_EQ(frame.clean, inside(frame.frame));
    }
}

TEST_F(NetworkFramesTest, HeedsItsParameters) {
    GivenFrame frame(width, height);
    DenoiserSettings settings;
    settings.kpcn.levels = 1;
    settings.kpcn.standardErrors = 0.5f;
    settings.kpcn.tile = 16;
    const std::pair<const char*, double> values[] = {
        {"kpcn.levels", 1}, {"kpcn.errors", 0.5}, {"kpcn.tile", 16}};
    for (const auto& [name, value] : values)
        ASSERT_EQ(limpid_network_set(network_, name, value), LIMPID_OK) << limpid_network_last_error();
    ASSERT_EQ(limpid_network_denoise(network_, &frame.given), LIMPID_OK) << limpid_network_last_error();
    EXPECT_EQ(frame.clean, inside(frame.frame, settings));
    EXPECT_NE(frame.clean, inside(frame.frame));
    limpid_parameter p;
    uint32_t count = 0;
    for (; limpid_network_parameter(count, &p) == LIMPID_OK; ++count) {
        EXPECT_GT(std::strlen(p.help), 0u) << p.name;
        EXPECT_EQ(limpid_network_set(network_, p.name, p.default_value), LIMPID_OK) << p.name;
        double value = -1.0;
        EXPECT_EQ(limpid_network_get(network_, p.name, &value), LIMPID_OK) << p.name;
        EXPECT_EQ(value, p.default_value) << p.name;
        for (const double bad : {p.maximum * 2 + 1, double{nan}}) {
            EXPECT_EQ(limpid_network_set(network_, p.name, bad), LIMPID_ERROR_INVALID_ARGUMENT) << p.name;
            EXPECT_THAT(limpid_network_last_error(), HasSubstr("outside its range")) << p.name;
        }
    }
    EXPECT_GT(count, 4u);
    EXPECT_EQ(limpid_network_parameter(count, &p), LIMPID_ERROR_INVALID_ARGUMENT);
    double value = 0.0;
    EXPECT_EQ(limpid_network_set(network_, "svgf.alpha", 0.5), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(limpid_network_get(network_, "svgf.alpha", &value), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(limpid_network_last_error(), HasSubstr("svgf.alpha"));
}

TEST_F(NetworkFramesTest, WhatIsLeftOutHasTheValueThatIsDocumented) {
    GivenFrame frame(width, height);
    for (const limpid_network_input out :
         {LIMPID_NETWORK_INPUT_SPECULAR, LIMPID_NETWORK_INPUT_SPECULAR_VARIANCE,
          LIMPID_NETWORK_INPUT_EMISSION, LIMPID_NETWORK_INPUT_ALBEDO, LIMPID_NETWORK_INPUT_ALBEDO_VARIANCE,
          LIMPID_NETWORK_INPUT_NORMAL_VARIANCE, LIMPID_NETWORK_INPUT_DEPTH_VARIANCE})
        frame.input(out).data = nullptr;
    ASSERT_EQ(limpid_network_denoise(network_, &frame.given), LIMPID_OK) << limpid_network_last_error();
    HostFrame same = frame.frame;
    for (std::vector<float>* const layer : {&same.specular, &same.emission})
        std::fill(layer->begin(), layer->end(), 0.0f);
    std::fill(same.albedo.begin(), same.albedo.end(), 1.0f);
    for (std::vector<float>* const layer : {&same.albedo, &same.normal, &same.depth})
        for (size_t p = 0; p < same.pixelCount(); ++p) (*layer)[4 * p + 3] = 0.0f;
    EXPECT_EQ(frame.clean, inside(same));
}

TEST_F(NetworkFramesTest, SaysWhatIsMissing) {
    GivenFrame frame(width, height);
    const std::pair<limpid_network_input, const char*> needed[] = {
        {LIMPID_NETWORK_INPUT_NORMAL, "'normal' is missing"},
        {LIMPID_NETWORK_INPUT_DEPTH, "'depth' is missing"},
        {LIMPID_NETWORK_INPUT_DIFFUSE_VARIANCE, "'diffuse_variance' is missing"},
        {LIMPID_NETWORK_INPUT_SPECULAR_VARIANCE, "'specular_variance' is missing"}};
    for (const auto& [input, why] : needed) {
        limpid_network_frame without = frame.given;
        without.inputs[input].data = nullptr;
        expectRefused(without, why);
    }
    limpid_network_frame dark = frame.given;
    dark.inputs[LIMPID_NETWORK_INPUT_DIFFUSE].data = dark.inputs[LIMPID_NETWORK_INPUT_SPECULAR].data =
        nullptr;
    expectRefused(dark, "both missing");
    limpid_network_frame blind = frame.given;
    blind.color.data = nullptr;
    expectRefused(blind, "color.data is NULL");
}

TEST_F(NetworkFramesTest, RefusesWhatCannotBe) {
    GivenFrame frame(width, height);
    const auto with = [&](const std::function<void(limpid_network_frame&)>& change) {
        limpid_network_frame changed = frame.given;
        change(changed);
        return changed;
    };
    expectRefused(with([](auto& f) { f.width = 0; }), "images of 0 x 23 pixels");
    expectRefused(with([](auto& f) { f.height = 32769; }), "each side has 1 to 32768");
    expectRefused(with([](auto& f) { f.size = 3; }), "size");
    expectRefused(with([](auto& f) { f.inputs[0].components = 1; }), "'diffuse' has 1 components");
    expectRefused(with([](auto& f) { f.inputs[5].components = 5; }), "'depth' has 5 components");
    expectRefused(with([](auto& f) { f.color.components = 2; }), "'color' has 2 components");
    expectRefused(with([](auto& f) { f.inputs[20] = f.inputs[0]; }), "there is no input 20");
    EXPECT_EQ(limpid_network_denoise(nullptr, &frame.given), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(limpid_network_denoise(network_, nullptr), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(limpid_network_set(network_, nullptr, 1.0), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(limpid_network_get(network_, "kpcn.tile", nullptr), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(limpid_network_create(nullptr, nullptr, nullptr), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_STREQ(limpid_network_device_name(nullptr), "");
    limpid_network_destroy(nullptr);
    EXPECT_EQ(limpid_network_denoise(network_, &frame.given), LIMPID_OK) << limpid_network_last_error();
}

TEST_F(NetworkFramesTest, NanCountsAsZeroAndIsTold) {
    GivenFrame frame(width, height);
    for (std::vector<float>* const layer :
         {&frame.frame.diffuse, &frame.frame.emission, &frame.frame.albedo, &frame.frame.normal})
        for (const size_t p : {3u, 77u}) (*layer)[4 * p + 1] = nan;
    frame.variances[0][5] = std::numeric_limits<float>::infinity();
    frame.depths[9] = nan;
    told_.clear();
    ASSERT_EQ(limpid_network_denoise(network_, &frame.given), LIMPID_OK) << limpid_network_last_error();
    for (const float value : frame.clean) ASSERT_TRUE(std::isfinite(value));
    EXPECT_THAT(told_, Contains(AllOf(HasSubstr("'diffuse': 2 pixels"), HasSubstr("NaN"))));
    EXPECT_THAT(told_, Contains(HasSubstr("'diffuse_variance': 1 pixels")));
    EXPECT_THAT(told_, Not(Contains(HasSubstr("'specular'"))));
    std::fill(frame.frame.specular.begin(), frame.frame.specular.end(), nan);
    expectRefused(frame.given, "'specular' has no finite pixel");
}

TEST_F(NetworkFramesTest, WeightsThatAreMissingOrDamagedAreNamed) {
    const image::test::TempFolder folder;
    const std::string damaged = (folder / "damaged.safetensors").string();
    std::ofstream(damaged) << "not weights at all";
    limpid_device_desc device = {sizeof device};
    const std::string select = wantedDevice();
    device.select = select.c_str();
    limpid_network_desc desc = {sizeof desc};
    limpid_network* network = nullptr;
    for (const std::string& file : {damaged, (folder / "none").string()}) {
        desc.weights = file.c_str();
        EXPECT_EQ(limpid_network_create(&device, &desc, &network), LIMPID_ERROR_UNREADABLE);
        EXPECT_THAT(limpid_network_last_error(), HasSubstr(file));
        EXPECT_EQ(network, nullptr);
    }
    device.select = "no such device";
    EXPECT_EQ(limpid_network_create(&device, nullptr, &network), LIMPID_ERROR_UNSUPPORTED);
    EXPECT_THAT(limpid_network_last_error(), HasSubstr("no such device"));
}

TEST_F(NetworkFramesTest, HasTheInstalledWeights) {
    limpid_network* network = open("");
    ASSERT_NE(network, nullptr);
    GivenFrame frame(16, 8);
    ASSERT_EQ(limpid_network_denoise(network, &frame.given), LIMPID_OK) << limpid_network_last_error();
    const std::vector<float> own = frame.clean;
    ASSERT_EQ(limpid_network_set(network, "kpcn.cis565", 1.0), LIMPID_OK) << limpid_network_last_error();
    ASSERT_EQ(limpid_network_denoise(network, &frame.given), LIMPID_OK) << limpid_network_last_error();
    EXPECT_NE(frame.clean, own);
    EXPECT_THAT(limpid_network_precision(network), HasSubstr("precision"));
    EXPECT_STRNE(limpid_network_device_name(network), "");
    limpid_network_destroy(network);
}

}  // namespace
}  // namespace limpid::test
