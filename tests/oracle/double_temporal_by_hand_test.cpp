// Tests the oracle of temporal accumulation with numbers computed by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/oracle/double_denoise_fixture.h"
#include "tests/oracle/double_temporal.h"

namespace limpid::test {
namespace {

using denoise::HostFrame;

/// The middle pixel of five by five reprojects to s = (2.75, 3): the taps (2, 2) and (2, 3) have weight 3/8
/// each, and (3, 2) and (3, 3) have 1/8. z' = 2.5 - 0.5. Its surface is tilted: c = 0.8, tan = 3/4.
class TemporalByHand : public testing::Test {
  protected:
    TemporalByHand() {
        frame.camera.spread = 0.1f;
        set(frame.depth, {2.5f, 1, 0});
        set(frame.motion, {0.25f, 0.5f, -0.5f});
        set(frame.normal, {0.6f, 0, 0.8f});
        set(frame.diffuse, {2, 2, 2});
        set(frame.albedo, {0.8f, 0.2f, 0.02f});
        before.colour.assign(25, dvec4(1, 1, 1, 4));
        before.normalDepth.assign(25, dvec4(0, 0, 1, 2));
        before.albedoId.assign(25, dvec4(0.8, 0.2, 0.02, 1));
    }

    /// Sets a layer's value for the middle pixel.
    void set(std::vector<float>& layer, const vec3& value) {
        for (int i = 0; i < 3; ++i) layer[static_cast<size_t>(4 * 12 + i)] = value[i];
    }
    dvec4 track() const { return accumulateTemporally(frame, before, params).images.colour[12]; }
    /// Returns whether the tap (2, 2) passes the tests. It alone has another count, so the new count shows
    /// it.
    bool counts() {
        before.colour[12].w = 12.0;
        const double count = track().w;
        EXPECT_NEAR(count, count > 6.0 ? 4.0 + 8.0 * 3.0 / 8.0 + 1.0 : 5.0, 1e-6);
        return count > 6.0;
    }

    HostFrame frame = frontalPlane(5, 5);
    TemporalImages before{5, 5, {}, {}, {}};
    DoubleTemporalParams params;
};

TEST_F(TemporalByHand, WeightsAndAlbedo) {
    before.colour[12] = dvec4(3, 3, 3, 8);  // weight 3/8: the mean is 7/4, the count 5.5
    EXPECT_LT(glm::distance(track(), dvec4(dvec3(1.75 + 0.25 / 6.5), 6.5)), 1e-6);
    before.albedoId[12] = dvec4(0.4, 0.8, 0.05, 1);  // the light was 1/2, 4 and 1 times that
    const dvec3 old = dvec3(5.0 + 3.0 * dvec3(6.0, 0.75, 3.0)) / 8.0;
    EXPECT_LT(glm::distance(track(), dvec4(old + (2.0 - old) / 6.5, 6.5)), 1e-6);
    params.minAlbedo = 0.0;
    EXPECT_LT(glm::distance(track(), dvec4(dvec3(1.75 + 0.25 / 6.5), 6.5)), 1e-6);
}

TEST_F(TemporalByHand, TestsOfATap) {
    EXPECT_TRUE(counts());
    const double t = 2.0 * (0.02 + 1.5 * 0.1 * 0.75);
    for (const double sign : {-1.0, 1.0}) {
        before.normalDepth[12].w = 2.0 + sign * 0.99 * t;
        EXPECT_TRUE(counts());
        before.normalDepth[12].w = 2.0 + sign * 1.01 * t;
        EXPECT_FALSE(counts());
    }
    params.relative = false;
    before.normalDepth[12].w = 2.019;
    EXPECT_TRUE(counts());
    before.normalDepth[12].w = 2.021;
    EXPECT_FALSE(counts());
    before.normalDepth[12] = dvec4(std::sin(0.31), 0.0, std::cos(0.31), 2.0);  // cos 0.3176 = 0.95
    EXPECT_TRUE(counts());
    before.normalDepth[12] = dvec4(std::sin(0.33), 0.0, std::cos(0.33), 2.0);
    EXPECT_FALSE(counts());
    before.normalDepth[12] = dvec4(0, 0, 1, 2);
    before.albedoId[12].w = 2.0;
    EXPECT_FALSE(counts());
}

TEST_F(TemporalByHand, OrthographicTolerance) {
    frame.camera.orthographic = 1;
    const double t = 2.0 * 0.02 + 1.5 * 0.1 * 0.75;
    before.normalDepth[12].w = 2.0 + 0.99 * t;
    EXPECT_TRUE(counts());
    before.normalDepth[12].w = 2.0 + 1.01 * t;
    EXPECT_FALSE(counts());
}

TEST_F(TemporalByHand, Search) {
    for (dvec4& texel : before.albedoId) texel.w = 7.0;
    before.albedoId[5 * 4 + 1].w = before.albedoId[5 * 2 + 3].w = 1.0;  // (1, 4); (3, 2) is a bilinear tap
    before.colour[5 * 4 + 1].w = 9.0;
    EXPECT_NEAR(track().w, 5.0, 1e-6);
    before.albedoId[5 * 2 + 3].w = 7.0;
    EXPECT_NEAR(track().w, 10.0, 1e-6);
    before.albedoId[5 * 4 + 3].w = 1.0;  // (3, 4)
    EXPECT_NEAR(track().w, (4.0 + 9.0) / 2.0 + 1.0, 1e-6);
    params.search = false;
    EXPECT_EQ(track(), dvec4(2, 2, 2, 1));
}

TEST_F(TemporalByHand, Doubt) {
    const auto doubtful = [this] { return accumulateTemporally(frame, before, params).pixels[12].doubtful; };
    EXPECT_FALSE(doubtful());
    before.normalDepth[12].w = 2.0 + 2.0 * (0.02 + 1.5 * 0.1 * 0.75) * 1.00005;
    EXPECT_TRUE(doubtful());
    before.albedoId[12].w = 7.0;  // another test already decides
    EXPECT_FALSE(doubtful());
    set(frame.motion, {0.4999f, 0, -0.5f});  // close to a pixel's edge, where bilinear weights are continuous
    EXPECT_FALSE(doubtful());
    for (dvec4& texel : before.albedoId) texel.w = 7.0;  // but the search is not continuous
    EXPECT_TRUE(doubtful());
    set(frame.motion, {0, 2.4999f, -0.5f});  // close to the picture's edge
    params.search = false;
    EXPECT_TRUE(doubtful());
    set(frame.motion, {0, 2.4f, -0.5f});
    EXPECT_FALSE(doubtful());
}

}  // namespace
}  // namespace limpid::test
