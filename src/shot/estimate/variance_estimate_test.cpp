// Tests estimated variances against noise whose variance is known.
#include "shot/estimate/variance_estimate.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace limpid::shot {
namespace {

using denoise::HostFrame;

constexpr uint32_t across = 64, down = 48;
constexpr uint32_t samplesOfFrame = 5;
constexpr float epsilon = 0.00316f;  // added to albedo

std::vector<const LayerInfo*> layersWithVariance() {
    std::vector<const LayerInfo*> layers;
    for (const LayerInfo& layer : frameLayers)
        if (layer.varianceInFiles) layers.push_back(&layer);
    return layers;
}

void fill(std::vector<float>& texels, const vec3& value) {
    texels.resize(size_t{4} * across * down);
    for (size_t i = 0; i < texels.size(); ++i) texels[i] = i % 4 < 3 ? value[static_cast<int>(i % 4)] : 0.0f;
}

/// A plane that faces the viewer at a distance of 3, of one object, in steady light.
HostFrame facingPlane() {
    HostFrame frame;
    frame.width = across;
    frame.height = down;
    frame.samples = samplesOfFrame;
    fill(frame.diffuse, vec3(1.0f));
    fill(frame.specular, vec3(1.0f));
    fill(frame.emission, vec3(0.0f));
    fill(frame.albedo, vec3(0.5f));
    fill(frame.normal, vec3(0, 0, 1));
    fill(frame.depth, vec3(3, 1, 0));
    frame.ids.assign(size_t{2} * across * down, 7);
    return frame;
}

/// Sets the light to light(x, y) and noise of the standard deviation noise(x, y), grey.
template <typename Light, typename Noise>
void setLight(std::vector<float>& texels, Light light, Noise noise, uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    for (size_t p = 0; p < texels.size() / 4; ++p) {
        const auto x = static_cast<uint32_t>(p % across), y = static_cast<uint32_t>(p / across);
        const float value = light(x, y) + noise(x, y) * normal(random);
        for (size_t c = 0; c < 3; ++c) texels[4 * p + c] = value;
    }
}

float varianceAt(const std::vector<float>& texels, uint32_t x, uint32_t y) {
    return texels[4 * (size_t{y} * across + x) + 3] / static_cast<float>(samplesOfFrame - 1);
}

/// The mean of variance / expected(x, y) over a rectangle.
template <typename Expected>
float meanRatio(const std::vector<float>& texels, uint32_t left, uint32_t right, Expected expected) {
    double sum = 0.0;
    for (uint32_t y = 0; y < down; ++y)
        for (uint32_t x = left; x < right; ++x)
            sum += static_cast<double>(varianceAt(texels, x, y) / expected(x, y));
    return static_cast<float>(sum / (down * (right - left)));
}

constexpr auto steady(float value) {
    return [value](uint32_t, uint32_t) { return value; };
}

TEST(VarianceEstimate, KnownNoiseOnSteadyLightIsFound) {
    HostFrame frame = facingPlane();
    setLight(frame.diffuse, steady(10.0f), steady(0.2f), 1);
    setLight(frame.specular, steady(3.0f), steady(0.05f), 2);
    estimateVariances(frame, layersWithVariance());
    EXPECT_NEAR(meanRatio(frame.diffuse, 0, across, steady(0.04f)), 1.0f, 0.08f);
    EXPECT_NEAR(meanRatio(frame.specular, 0, across, steady(0.0025f)), 1.0f, 0.08f);
    for (uint32_t x = 0; x < across; ++x) {
        EXPECT_GT(varianceAt(frame.diffuse, x, 20), 0.3f * 0.04f) << x;
        EXPECT_LT(varianceAt(frame.diffuse, x, 20), 2.5f * 0.04f) << x;
    }
    for (const auto* guide : {&frame.albedo, &frame.normal}) EXPECT_EQ(varianceAt(*guide, 20, 20), 0.0f);
}

TEST(VarianceEstimate, TexturesAreNoNoise) {
    HostFrame frame = facingPlane();
    const auto albedo = [](uint32_t x, uint32_t y) { return (x / 2 + y / 3) % 2 == 0 ? 0.1f : 0.9f; };
    setLight(frame.albedo, albedo, steady(0.0f), 1);
    const auto noise = [&](uint32_t x, uint32_t y) { return 0.2f * (albedo(x, y) + epsilon); };
    setLight(
        frame.diffuse, [&](uint32_t x, uint32_t y) { return 4.0f * (albedo(x, y) + epsilon); }, noise, 3);
    frame.albedoSpecular = frame.albedo;
    setLight(
        frame.specular, [&](uint32_t x, uint32_t y) { return 4.0f * (albedo(x, y) + epsilon); }, noise, 4);
    estimateVariances(frame, layersWithVariance());
    const auto expected = [&](uint32_t x, uint32_t y) { return noise(x, y) * noise(x, y); };
    EXPECT_NEAR(meanRatio(frame.diffuse, 0, across, expected), 1.0f, 0.08f);
    EXPECT_NEAR(meanRatio(frame.specular, 0, across, expected), 1.0f, 0.08f);
}

TEST(VarianceEstimate, GradientsOfLightAreNoNoise) {
    HostFrame frame = facingPlane();
    const auto ramp = [](uint32_t x, uint32_t y) { return 1.0f + 0.5f * static_cast<float>(2 * x + y); };
    setLight(frame.diffuse, ramp, steady(0.0f), 1);
    estimateVariances(frame, layersWithVariance());
    for (uint32_t x = 0; x < across; x += 7)
        EXPECT_LT(varianceAt(frame.diffuse, x, 20), 1e-3f) << "0.25 is a step's quarter square; " << x;
}

TEST(VarianceEstimate, FirefliesAreUncertainAndTheirNeighboursAreNot) {
    HostFrame frame = facingPlane();
    setLight(frame.diffuse, steady(1.0f), steady(0.1f), 8);
    const size_t firefly = 4 * (size_t{20} * across + 30);
    for (size_t c = 0; c < 3; ++c) frame.diffuse[firefly + c] = 51.0f;
    estimateVariances(frame, layersWithVariance());
    EXPECT_NEAR(varianceAt(frame.diffuse, 30, 20), 2500.0f, 500.0f);
    for (const uint32_t x : {27u, 28u, 33u}) EXPECT_LT(varianceAt(frame.diffuse, x, 20), 25.0f) << x;
}

/// Two halves that differ in one guide; their light differs by 100 standard deviations.
TEST(VarianceEstimate, OtherSurfacesDoNotCount) {
    const auto isRight = [](size_t p) { return p % across >= across / 2; };
    for (const char* guide : {"id", "depth", "normal", "sky"}) {
        HostFrame frame = facingPlane();
        const auto light = [](uint32_t x, uint32_t) { return x < across / 2 ? 1.0f : 21.0f; };
        const auto noise = [](uint32_t x, uint32_t) { return x < across / 2 ? 0.02f : 0.2f; };
        setLight(frame.diffuse, light, noise, 5);
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            if (!isRight(p)) continue;
            const std::string_view name = guide;
            if (name == "id") frame.ids[2 * p] = 8;
            if (name == "depth") frame.depth[4 * p] = 9.0f;
            if (name == "normal") frame.normal[4 * p] = 1.0f, frame.normal[4 * p + 2] = 0.0f;
            if (name == "sky") frame.depth[4 * p] = frame.depth[4 * p + 1] = 0.0f;
        }
        estimateVariances(frame, layersWithVariance());
        const auto expected = [&](uint32_t x, uint32_t y) { return noise(x, y) * noise(x, y); };
        EXPECT_NEAR(meanRatio(frame.diffuse, 0, across / 2 - 4, expected), 1.0f, 0.15f) << guide;
        EXPECT_NEAR(meanRatio(frame.diffuse, across / 2, across, expected), 1.0f, 0.15f) << guide;
        EXPECT_LT(varianceAt(frame.diffuse, across / 2 - 1, 20), 0.2f)
            << "far below the step's 100; " << guide;
    }
}

TEST(VarianceEstimate, AlwaysFiniteWhateverTheFrameHolds) {
    HostFrame frame = facingPlane();
    setLight(frame.diffuse, steady(1.0f), steady(0.1f), 6);
    frame.specular.clear();
    frame.albedoSpecular.clear();
    frame.samples = 1;
    frame.diffuse[4 * 500] = NAN;
    frame.diffuse[4 * 900 + 1] = INFINITY;
    frame.diffuse[4 * 1300] = -3.0f;
    frame.normal[4 * 700] = NAN;
    for (size_t i = 0; i < 3; ++i) frame.normal[4 * 720 + i] = 0.0f;
    frame.depth[4 * 1500] = NAN;
    frame.depth[4 * 1600] = 1e-20f;
    frame.ids[2 * 1700] = 1;  // a pixel that is like no other
    for (size_t i = 0; i < 3; ++i) frame.albedo[4 * 1800 + i] = 0.0f;
    estimateVariances(frame, layersWithVariance());
    ASSERT_EQ(frame.specular.size(), frame.diffuse.size()) << "networks see two sides";
    EXPECT_EQ(frame.samples, 2u);
    for (const LayerInfo* layer : layersWithVariance())
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            const float variance = frame[*layer][4 * p + 3];
            ASSERT_TRUE(std::isfinite(variance) && variance >= 0.0f) << layer->name << " " << p;
        }
    EXPECT_NEAR(frame.diffuse[4 * 1700 + 3], 0.01f, 0.02f) << "compared with all";
    EXPECT_GT(frame.diffuse[4 * 1700 + 3], 0.0f);
}

TEST(VarianceEstimate, OnlyTheGivenLayersChange) {
    HostFrame frame = facingPlane();
    setLight(frame.diffuse, steady(1.0f), steady(0.1f), 7);
    frame.specular[3] = frame.normal[3] = 42.0f;
    for (const LayerInfo* layer : layersWithVariance())
        if (layer->member == "diffuse") estimateVariances(frame, std::array{layer});
    EXPECT_GT(frame.diffuse[3], 0.0f);
    EXPECT_EQ(frame.specular[3], 42.0f);
    EXPECT_EQ(frame.normal[3], 42.0f);
}

}  // namespace
}  // namespace limpid::shot
