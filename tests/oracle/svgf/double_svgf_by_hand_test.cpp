// Tests the oracle of SVGF with numbers computed by hand.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "tests/oracle/double_denoise_fixture.h"
#include "tests/oracle/svgf/double_svgf.h"

namespace limpid::test {
namespace {

using denoise::HostFrame;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// The middle pixel of five by five reprojects to s = (2.75, 3): the taps (2, 2) and (2, 3) have weight 3/8
/// each, and (3, 2) and (3, 3) have 1/8. Its light is 2 in every component, its albedo 0.5: x is 4.
class SvgfByHand : public testing::Test {
  protected:
    SvgfByHand() {
        set(frame.motion, 4 * middle, {0.25f, 0.5f, 0});
        set(frame.diffuse, 4 * middle, {2, 2, 2});
        before.surfaces = svgfSurfaces(frame);
        before.color.assign(25, dvec4(1, 2, 3, nan));
        before.moments.assign(25, dvec4(1, 3, 2, 2));
    }

    static void set(std::vector<float>& layer, size_t at, const vec3& value) {
        for (int i = 0; i < 3; ++i) layer[at + static_cast<size_t>(i)] = value[i];
    }
    /// Includes anti-lag.
    SvgfAccumulated accumulate() const {
        SvgfAccumulated result = svgfAccumulate(frame, SvgfSignal::Diffuse, before, params);
        svgfShorten(frame, SvgfSignal::Diffuse, tiles, params, result);
        return result;
    }
    void expect(const dvec3& color, const dvec4& moments) const {
        const SvgfAccumulated result = accumulate();
        const double ofOne = std::sqrt(std::max(moments.y - moments.x * moments.x, 0.0));
        const double sigma = ofOne * 2.0 / std::sqrt(std::max(moments.w, 1.0));
        EXPECT_LT(glm::distance(result.color[middle], dvec4(color, sigma)), 1e-6);
        EXPECT_LT(glm::distance(result.moments[middle], moments), 1e-6);
        EXPECT_FALSE(result.pixels[middle].doubtful);
    }

    static constexpr size_t middle = 12;
    HostFrame frame = frontalPlane(5, 5);
    SvgfHistory before{5, 5, {}, {}, {}, {}};
    std::vector<double> tiles{0.0};
    DoubleSvgfParams params;
};

TEST_F(SvgfByHand, Accumulation) {
    // A third of the third frame; the fast mean uses a larger share.
    expect(dvec3(2, 8.0 / 3, 10.0 / 3), dvec4(2, 3 + 13.0 / 3, 3, 3));
    before.moments[middle] = dvec4(3, 11, 6, 10);  // weight 3/8: 7/4, 6, 7/2, 5; five frames is the maximum
    expect(dvec3(1.6, 2.4, 3.2), dvec4(1.75 + 0.45, 6 + 2, 3.5 + 0.25, 5));
    params.alpha = 0.5;  // 0.2 is still the minimum
    expect(dvec3(2.5, 3, 3.5), dvec4(1.75 + 0.45, 6 + 2, 3.5 + 0.25, 5));
    params.alphaMoments = 0.5;  // at least four frames
    expect(dvec3(2.5, 3, 3.5), dvec4(1.75 + 1.125, 6 + 5, 3.5 + 0.25, 4));
    const double sigma = accumulate().color[middle].w;  // four frames count as one
    params.boost = false;
    EXPECT_DOUBLE_EQ(accumulate().color[middle].w, sigma);
}

TEST_F(SvgfByHand, NothingFound) {
    for (double& id : before.surfaces.id) id = 7.0;
    params.search = false;
    expect(dvec3(4), dvec4(4, 16, 4, 1));
    EXPECT_EQ(accumulate().pixels[middle].failure, 3);
    frame.diffuse[4 * middle] = std::numeric_limits<float>::infinity();
    expect(dvec3(0), dvec4(0));
    EXPECT_TRUE(accumulate().pixels[middle].rejected);
    frame.depth[4 * middle] = frame.depth[4 * middle + 1] = 0.0f;  // the sky
    EXPECT_EQ(accumulate().color[middle], dvec4(0, 0, 0, -1));
    frame.diffuse[4 * middle] = 2.0f;
    EXPECT_EQ(accumulate().color[middle], dvec4(2, 2, 2, -1));
    EXPECT_EQ(accumulate().moments[middle], dvec4(0));
}

TEST_F(SvgfByHand, TapsOfOtherBumpsWeighLess) {
    const double turned = 1.0 - std::cos(0.1), weight = std::exp(-turned * 2.0 / (0.36 * 0.36));
    for (const size_t right : {13, 18}) {  // of weight 1/8
        before.surfaces.normal[right] = {std::sin(0.1), 0, std::cos(0.1)};
        before.color[right] = dvec4(9);
    }
    frame.roughness.assign(4 * 25, 0.6f);
    frame.specular[4 * middle] = std::numeric_limits<float>::quiet_NaN();  // leaves what was found
    params.lobeTest = 2.0;
    const auto found = [&] {
        return svgfAccumulate(frame, SvgfSignal::Specular, before, params).color[middle].x;
    };
    EXPECT_NEAR(found(), (0.75 * 1 + 0.25 * weight * 9) / (0.75 + 0.25 * weight), 1e-5);
    params.lobeTest = 0.0;
    EXPECT_NEAR(found(), 3.0, 1e-6);
}

TEST_F(SvgfByHand, ATapNeedsALength) {
    before.moments[12].w = before.moments[17].w = 0.0;  // both of weight 3/8
    before.color[12] = before.color[17] = dvec4(100);
    expect(dvec3(2, 8.0 / 3, 10.0 / 3), dvec4(2, 3 + 13.0 / 3, 3, 3));
}

TEST_F(SvgfByHand, AntiLagShortensTheHistory) {
    tiles[0] = 0.75;  // halves the two frames before this one
    const double a = 1 / 1.5;
    expect(dvec3(1 + 3 * a, 2 + 2 * a, 3 + a), dvec4(1 + 3 * a, 3 + 13 * a, 2 + 2 * a, 1.5));
    params.alpha = 0.8;  // larger than a
    expect(dvec3(1 + 3 * 0.8, 2 + 2 * 0.8, 3 + 0.8), dvec4(1 + 3 * a, 3 + 13 * a, 2 + 2 * a, 1.5));
    params.alpha = 1.0;
    expect(dvec3(4), dvec4(1 + 3 * a, 3 + 13 * a, 2 + 2 * a, 1.5));
    params.alpha = 0.2;
    frame.diffuse[4 * middle + 1] = std::numeric_limits<float>::quiet_NaN();
    expect(dvec3(1, 2, 3), dvec4(1, 3, 2, 2));
    frame.diffuse[4 * middle + 1] = 2.0f;
    tiles[0] = 1.0;
    expect(dvec3(4), dvec4(4, 16, 4, 1 - 0x1p-9));
    before.moments.assign(25, dvec4(1, 3, 2, 9));  // five frames is the maximum: a share of 0.2 becomes 0.5
    tiles[0] = 0.75;
    expect(dvec3(2.5, 3, 3.5), dvec4(2.5, 9.5, 3, 2));
}

TEST_F(SvgfByHand, AntiLagLeavesWhatHasNoHistory) {
    tiles[0] = 0.75;
    for (double& id : before.surfaces.id) id = 7.0;
    params.search = false;
    expect(dvec3(4), dvec4(4, 16, 4, 1));
    frame.depth[4 * middle] = frame.depth[4 * middle + 1] = 0.0f;  // the sky
    EXPECT_EQ(accumulate().color[middle], dvec4(2, 2, 2, -1));
    EXPECT_EQ(accumulate().moments[middle], dvec4(0));
}

TEST_F(SvgfByHand, StableLightIsFollowed) {
    EXPECT_EQ(accumulate().stablePast[middle], dvec3(0)) << "nothing so far";
    before.stable.assign(25, dvec3(4, 5, 6));
    before.stable[12] = before.stable[17] = dvec3(8, 5, 6);  // both of weight 3/8
    EXPECT_LT(glm::distance(accumulate().stablePast[middle], dvec3(7, 5, 6)), 1e-6);
    tiles[0] = 1.0;
    EXPECT_LT(glm::distance(accumulate().stablePast[middle], dvec3(7, 5, 6)), 1e-6)
        << "anti-lag leaves it alone";
    frame.depth[4 * middle] = frame.depth[4 * middle + 1] = 0.0f;  // the sky
    EXPECT_EQ(accumulate().stablePast[middle], dvec3(0));
}

TEST_F(SvgfByHand, StableLightWeighsAsTheHistoryIsLong) {
    params.stabilisationAlpha = 0.25;
    EXPECT_EQ(svgfStableWeight(0.0, true, params), 1.0);
    EXPECT_EQ(svgfStableWeight(1.0, true, params), 1.0);
    EXPECT_EQ(svgfStableWeight(1.0 - 0x1p-9, true, params), 0.5) << "anti-lag leaves stable light alone";
    EXPECT_EQ(svgfStableWeight(1.5, true, params), 0.5);
    EXPECT_EQ(svgfStableWeight(2.0, true, params), 0.5);
    EXPECT_EQ(svgfStableWeight(9.0, true, params), 0.25);
    EXPECT_EQ(svgfStableWeight(9.0, false, params), 1.0);
}

TEST_F(SvgfByHand, StableLightIsDecoded) {
    EXPECT_EQ(decodeStable(0), dvec3(0));
    EXPECT_EQ(decodeStable(255u | 1u << 9 | 0x1FFu << 18 | 23u << 27), dvec3(255, 1, -1));
    EXPECT_EQ(decodeStable(0x100u | 31u << 27), dvec3(-65536, 0, 0));
}

TEST_F(SvgfByHand, StableLightIsAMeanWithWhatWas) {
    params.stabilisationNoise = 2.0;
    const dvec4 color(1, 1, 1, 0.25), past(1.4, 1.4, 1.4, 0.25);
    EXPECT_LT(glm::distance(svgfStable(color, past, params), dvec3(1.3)), 1e-9);
    params.stabilisationNoise = 0.5;  // 0.125 and the floor's 0.001 of 0.4
    EXPECT_LT(glm::distance(svgfStable(color, past, params), dvec3(1 + 0.75 * 0.126)), 1e-9);
    params.stabilisationNoise = 0.0;
    EXPECT_LT(glm::distance(svgfStable(color, past, params), dvec3(1.00075)), 1e-9);
    EXPECT_EQ(svgfStable(color, dvec4(9, 9, 9, 1), params), dvec3(1));
    EXPECT_EQ(svgfStable(dvec4(0), dvec4(0), params), dvec3(0));
}

TEST_F(SvgfByHand, Signals) {
    set(frame.specular, 4 * middle, {1, 1, 1});
    frame.albedo[4 * middle] = 0.05f;
    const auto x = [&](SvgfSignal signal, double minAlbedo = 0.1) {
        return svgfSample(frame, signal, middle, minAlbedo).x;
    };
    EXPECT_LT(glm::distance(x(SvgfSignal::Diffuse), dvec3(20, 4, 4)), 1e-6);
    EXPECT_LT(glm::distance(x(SvgfSignal::Specular), dvec3(10)), 1e-6) << "no albedo is known";
    EXPECT_LT(glm::distance(x(SvgfSignal::Joint), dvec3(30, 6, 6)), 1e-6);
    EXPECT_EQ(x(SvgfSignal::Joint, 0.0), dvec3(3));
    frame.albedoSpecular.assign(100, 0.25f);
    EXPECT_LT(glm::distance(x(SvgfSignal::Specular), dvec3(4)), 1e-6);
    EXPECT_LT(glm::distance(x(SvgfSignal::Joint), dvec3(10, 4, 4)), 1e-6);
    set(frame.diffuse, 4 * middle, {1e30f, -1e30f, 1});
    EXPECT_EQ(x(SvgfSignal::Diffuse), dvec3(65504, -65504, 2));
    frame.albedo[4 * middle + 1] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(x(SvgfSignal::Diffuse).z, 1.0) << "an albedo with a NaN is none";
    frame.albedo[4 * middle + 1] = 1e9f;
    EXPECT_EQ(svgfModulate(frame, {{SvgfSignal::Diffuse, std::vector<dvec4>(25, dvec4(1))}}, 0.1)[middle].y,
              65504.0);
    frame.albedo[4 * middle + 1] = 1.0f;
    frame.specular[4 * middle] = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(svgfSample(frame, SvgfSignal::Diffuse, middle, 0.1).rejected);
    EXPECT_TRUE(svgfSample(frame, SvgfSignal::Joint, middle, 0.1).rejected);
    const std::vector<dvec4> light(25, dvec4(1, 2, 3, 9));
    frame.emission.assign(100, 0.5f);
    const std::vector<dvec4> sum =
        svgfModulate(frame, {{SvgfSignal::Diffuse, light}, {SvgfSignal::Specular, light}}, 0.1);
    EXPECT_LT(glm::distance(sum[middle], dvec4(0.5 + 0.1 + 0.25, 0.5 + 2 + 0.5, 0.5 + 1.5 + 0.75, 1)), 1e-6);
    EXPECT_EQ(svgfModulate(frame, {{SvgfSignal::Joint, light}}, false)[middle], dvec4(1.5, 2.5, 3.5, 1));
}

/// Old colours are the positions of their pixels, and no sample counts, so the result tells where the history
/// was found.
class SvgfReflectionsByHand : public SvgfByHand {
  protected:
    SvgfReflectionsByHand() {
        frame.reflectionMotion.assign(100, 0.0f);
        frame.diffuse.assign(100, std::numeric_limits<float>::quiet_NaN());
        frame.specular = frame.diffuse;
        for (size_t q = 0; q < 25; ++q)
            before.color[q] = {static_cast<double>(q % 5) + 0.5, static_cast<double>(q / 5) + 0.5, 1, nan};
    }

    void reflect(size_t p, const vec3& r, float w = 1.0f) {
        set(frame.reflectionMotion, 4 * p, w * r);
        frame.reflectionMotion[4 * p + 3] = w;
    }
    void expectAt(const dvec2& s, size_t p = middle, SvgfSignal signal = SvgfSignal::Specular) const {
        const SvgfAccumulated result = svgfAccumulate(frame, signal, before, params);
        EXPECT_LT(glm::distance(dvec3(result.color[p]), dvec3(s, 1)), 1e-6);
        EXPECT_FALSE(result.pixels[p].doubtful);
    }

    static constexpr dvec2 byMotion{2.75, 3};
};

TEST_F(SvgfReflectionsByHand, ReplaceTheMotionOfSpecularLight) {
    expectAt(byMotion);
    reflect(middle, {-1, -0.75f, 0.01f});
    expectAt({1.5, 1.75});
    expectAt(byMotion, middle, SvgfSignal::Diffuse);
    expectAt(byMotion, middle, SvgfSignal::Joint);
    params.reflections = false;
    expectAt(byMotion);
    params.reflections = true;
    reflect(middle, {-1, -0.75f, 0.01f}, 0.5f);
    expectAt({1.5, 1.75});
    frame.motion[4 * middle + 3] = 0.0f;
    expectAt({1.5, 1.75});
    frame.motion[4 * middle + 3] = 1.0f;
    frame.reflectionMotion.clear();
    expectAt(byMotion);
}

TEST_F(SvgfReflectionsByHand, MeanOfNinePixels) {
    reflect(6, {-1, -1, 0});
    reflect(18, {0.5f, 0.5f, 0}, 0.25f);  // equal weight
    for (const size_t other : {7, 8, 11, 13, 16, 17, 0, 10, 14, 24}) reflect(other, {1, 1, 0});
    frame.ids[2 * 7] = 3;
    for (size_t i = 0; i < 4; ++i)  // 8, 11, 16, 17
        frame.reflectionMotion[4 * std::array<size_t, 4>{8, 11, 16, 17}[i] + i] =
            i % 2 == 0 ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
    frame.reflectionMotion[4 * 13 + 3] = 0.0f;
    expectAt({2.25, 2.25});
}

TEST_F(SvgfReflectionsByHand, MeanAtTheEdgesOfThePicture) {
    for (const size_t other : {0, 4, 9, 14, 19, 23}) reflect(other, {0, 2, 0});  // 4, 9, 14: in other rows
    frame.ids[0] = 3;
    reflect(5, {1, 0, 0});
    expectAt({1.5, 1.5}, 5);
    reflect(24, {-2, -4, 0});
    frame.ids[2 * 19] = frame.ids[2 * 23] = 3;
    expectAt({2.5, 0.5}, 24);
}

TEST_F(SvgfReflectionsByHand, WhereTheyLeadNowhereTheMotionLeads) {
    reflect(middle, {-3, 0, 0});  // outside
    expectAt(byMotion);
    reflect(middle, {-1, -0.75f, 1});  // too far away
    expectAt(byMotion);
    frame.motion[4 * middle + 3] = 0.0f;
    EXPECT_EQ(svgfAccumulate(frame, SvgfSignal::Specular, before, params).color[middle], dvec4(0));
    frame.motion[4 * middle + 3] = 1.0f;
    reflect(middle, {-1, -0.75f, 0});
    before.moments[6].w = before.moments[11].w = 0.0;  // disables all taps, but not all of the nine pixels
    expectAt({1.5, 9.5 / 7});
    params.search = false;
    expectAt(byMotion);
    reflect(middle, {2.5f, 0, 0});
    EXPECT_TRUE(svgfAccumulate(frame, SvgfSignal::Specular, before, params).pixels[middle].doubtful)
        << "on the edge of the picture";
    expectAt(byMotion, middle, SvgfSignal::Diffuse);
}

TEST(SvgfTilesByHand, ChangeBeyondNoise) {
    // With nine columns, the second tile is a single column of pixels.
    const HostFrame frame = frontalPlane(9, 8);
    // One third frame that is three times as bright as the previous ones.
    std::vector<dvec4> moments(72, dvec4(1.4, 2.6, 2.0, 5));
    const DoubleSvgfParams params;
    EXPECT_NEAR(svgfSteadyShare(params), 0.125, 1e-12);  // (1/3 + 1/9 - 2/6) / (8/9)
    const double lag = 2.0 * (64 * 0.6 - 3.0 * std::sqrt(64 * 0.125 * 0.64)) / (64 * 2.0);
    SvgfTiles tiles = svgfTiles(frame, moments, params);
    ASSERT_EQ(tiles.tiles.size(), 2u);
    EXPECT_NEAR(tiles.tiles[0], lag, 1e-12);
    // With fewer pixels, the same deviation may be noise.
    const double thinLag = 2.0 * (8 * 0.6 - 3.0 * std::sqrt(8 * 0.125 * 0.64)) / (8 * 2.0);
    EXPECT_NEAR(tiles.tiles[1], thinLag, 1e-12);
    for (size_t p = 0; p < 72; ++p) moments[p] = p % 9 == 8 ? dvec4(1, 1, 9, 1.4) : dvec4(1, 2, 1.1, 2);
    tiles = svgfTiles(frame, moments, params);
    EXPECT_EQ(tiles.tiles[1], 0.0) << "too young";
    EXPECT_EQ(tiles.tiles[0], 0.0) << "3 sqrt(64 / 8) exceeds 6.4";
    moments.assign(72, dvec4(1, 60, 9, 5));
    EXPECT_EQ(svgfTiles(frame, moments, {.antilag = 10.0}).tiles[0], 1.0);
    moments.assign(72, dvec4(0, 0, 0, 5));
    EXPECT_EQ(svgfTiles(frame, moments, params).tiles[0], 0.0);
}

TEST(SvgfTilesByHand, SmallChangesOverThreeByThreeTiles) {
    const HostFrame frame = frontalPlane(40, 32);  // 5x4 tiles
    // f - m1 is 0.2 with a deviation of 0.64: 64 pixels are not enough to tell it from noise, 4 x 64 are.
    std::vector<dvec4> moments(size_t{40} * 32, dvec4(1.0, 4.2768, 1.2, 9));
    const double v = 0.125 * 3.2768;
    const auto lagOf = [&](double tiles) {
        return 2.0 * std::max(tiles * 64 * 0.2 - 3.0 * std::sqrt(tiles * 64 * v), 0.0) / (tiles * 64 * 1.2);
    };
    SvgfTiles tiles = svgfTiles(frame, moments, {.antilagAround = true});
    ASSERT_EQ(tiles.tiles.size(), 20u);
    EXPECT_NEAR(tiles.tiles[0], lagOf(4), 1e-12) << "a corner";
    EXPECT_NEAR(tiles.tiles[2], lagOf(6), 1e-12) << "an edge";
    EXPECT_NEAR(tiles.tiles[7], lagOf(9), 1e-12) << "inside";
    EXPECT_NEAR(tiles.tiles[19], lagOf(4), 1e-12) << "the last corner";
    EXPECT_EQ(svgfTiles(frame, moments, {}).tiles[7], 0.0);
    // A change of one tile alone is larger there than in the mean of nine.
    for (dvec4& m : moments) m = {1.0, 1.0 + 1e-12, 1.0, 9};
    for (size_t y = 8; y < 16; ++y)
        for (size_t x = 16; x < 24; ++x) moments[y * 40 + x].z = 1.5;
    tiles = svgfTiles(frame, moments, {.antilagAround = true});
    EXPECT_NEAR(tiles.tiles[7], 2.0 * 0.5 / 1.5, 1e-5);
    EXPECT_NEAR(tiles.tiles[6], 2.0 * 0.5 / 9.5, 1e-5) << "beside it";
    EXPECT_EQ(tiles.tiles[5], 0.0);
}

TEST(SvgfTilesByHand, APixelIsTakenAtItsWordAsFarAsItsNoiseReaches) {
    const HostFrame frame = frontalPlane(8, 8);
    // 0.6, of which 0.5 sqrt(0.125 0.64) counts.
    std::vector<dvec4> moments(64, dvec4(1.4, 2.6, 2.0, 5));
    DoubleSvgfParams params{.antilagPixel = 0.5};
    const double deviation = std::sqrt(0.125 * 0.64), lag = 2.0 * (32 - 3.0 * 8) * deviation / (64 * 2.0);
    EXPECT_NEAR(svgfTiles(frame, moments, params).tiles[0], lag, 1e-12);
    moments.assign(64, dvec4(2.6, 7.4, 2.0, 5));  // darker: the same deviation
    EXPECT_NEAR(svgfTiles(frame, moments, params).tiles[0], lag * 2.0 / 2.6, 1e-12);
    // A firefly of 100 in its first frame, in steady light: limited to less than a tile's noise.
    moments.assign(64, dvec4(1, 1, 1, 5));
    moments[9] = dvec4(20.8, 2000.8, 50.5, 5);
    params.antilagNoise = 1.5;
    EXPECT_EQ(svgfTiles(frame, moments, params).tiles[0], 0.0);
    params.antilagPixel = 1.499;  // less than 1.5, so that one pixel never suffices
    EXPECT_EQ(svgfTiles(frame, moments, params).tiles[0], 0.0);
    params.antilagPixel = 1e9;
    EXPECT_GT(svgfTiles(frame, moments, params).tiles[0], 0.1);
}

TEST(SvgfTilesByHand, ErrorsOfMomentsAreCarriedThrough) {
    const HostFrame frame = frontalPlane(8, 8);
    const DoubleSvgfParams params{.antilagPixel = 2.0};
    const std::vector<dvec4> moments(64, dvec4(1.4, 2.6, 2.0, 5));
    const double lag = svgfTiles(frame, moments, params).tiles[0];
    for (const double sign : {1.0, -1.0}) {
        for (int component = 0; component < 3; ++component) {
            std::vector<dvec4> errors(64, dvec4(0)), off = moments;
            for (dvec4& e : errors) e[component] = 1e-3;
            for (dvec4& m : off) m[component] += sign * 1e-3;
            const double bound = svgfTiles(frame, moments, params, errors).error[0];
            EXPECT_LE(std::abs(svgfTiles(frame, off, params).tiles[0] - lag), bound) << component;
            EXPECT_LT(bound, 0.02) << component;
        }
    }
    std::vector<dvec4> errors(64, dvec4(0));
    errors[63].w = 3.6;
    EXPECT_TRUE(std::isinf(svgfTiles(frame, moments, params, errors).error[0])) << "may be too young";
}

/// A row of sixteen pixels with two tiles, whose centres are at 4 and 12.
TEST(SvgfTilesByHand, AreReadBilinearly) {
    const HostFrame frame = frontalPlane(16, 1);
    const std::vector<dvec4> zeros(16, dvec4(0));
    SvgfAccumulated result{zeros, std::vector<dvec4>(16, dvec4(0, 0, 0, 3)), std::vector<dvec3>(16, dvec3(0)),
                           std::vector<SvgfPixel>(16)};
    svgfShorten(frame, SvgfSignal::Joint, {0.0, 0.8}, {}, result);
    for (size_t p = 0; p < 16; ++p) {
        const double lag = 0.8 * glm::clamp((static_cast<double>(p) + 0.5 - 4.0) / 8.0, 0.0, 1.0);
        EXPECT_NEAR(result.moments[p].w, 1.0 + 2.0 * (lag < 0.1 ? 1.0 : 1.0 - lag), 1e-12) << p;
    }
}

/// Three pixels in a row, with the rays (-2/3, 0, -1), (0, 0, -1) and (2/3, 0, -1).
class SvgfRow : public testing::Test {
  protected:
    /// Checks the right neighbour's weight relative to 1, from the middle pixel; the left ray misses.
    void expectWeight(double weight) const {
        const dvec4 result = svgfLevel(frame, signal, surfaces, color, 0, params)[1];
        const double centre = 36, right = 24 * weight, sum = centre + right;
        const dvec3 mean = (centre * dvec3(color[1]) + right * dvec3(color[2])) / sum;
        const double sigma = std::hypot(centre * color[1].w, right * color[2].w) / sum;
        EXPECT_LT(glm::distance(result, dvec4(mean, sigma)), 1e-9);
    }

    HostFrame frame = frontalPlane(3, 1);
    SvgfSurfaces surfaces{{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {0, 2, 2}, {0, 1, 1}, {1, 1, 1}};
    std::vector<dvec4> color{{9, 9, 9, -1}, {1, 1, 1, 0.3}, {2, 1, 1, 0.6}};
    DoubleSvgfParams params{.phiColor = 1e9};
    SvgfSignal signal = SvgfSignal::Diffuse;
};

TEST_F(SvgfRow, VarianceOfAWeightedMean) {
    expectWeight(1.0);
    EXPECT_EQ(svgfLevel(frame, SvgfSignal::Diffuse, surfaces, color, 0, params)[0], color[0]);
    EXPECT_LT(glm::distance(svgfLevel(frame, SvgfSignal::Diffuse, surfaces, color, 1, params)[1], color[1]),
              1e-12)
        << "both are out of reach";
}

TEST_F(SvgfRow, Color) {
    params.phiColor = 0.5;
    params.blurLevels = 0;
    expectWeight(std::exp(-0.2126 / (0.5 * 0.3 + 0.001 + 1e-6)));
    params.blurLevels = 1;
    const double g = (4 * 0.09 + 2 * 0.36) / 6;
    expectWeight(std::exp(-0.2126 / (0.5 * std::sqrt(g) + 0.001 + 1e-6)));
}

TEST_F(SvgfRow, TheMeanLuminanceOfLikePixels) {
    params.phiColor = 0.5;
    params.blurLevels = 0;
    params.meanLevels = 1;
    const double tolerance = 0.5 * 0.3 + 0.001 + 1e-6;
    const double first = std::exp(-0.2126 / tolerance), mean = 1.0 + 0.2126 * first / (1.0 + first);
    expectWeight(std::exp(-(1.2126 - mean) / tolerance));
    surfaces.distance[2] = 2.003;
    const double surface = std::exp(-1.5), like = first * surface;
    expectWeight(surface * std::exp(-(0.2126 - 0.2126 * like / (1.0 + like)) / tolerance));
    params.meanLevels = 0;
    expectWeight(surface * first);
}

TEST_F(SvgfRow, OutliersCountLess) {
    params.dampOutliers = true;
    params.wide = false;
    const HostFrame row = frontalPlane(5, 1);
    const SvgfSurfaces plane{std::vector(5, dvec3(0, 0, 1)), std::vector(5, 2.0), std::vector(5, 1.0),
                             std::vector(5, 1.0)};
    std::vector<dvec4> light(5, {1, 1, 1, 0.3});
    light[2] = {5, 5, 5, 1.2};
    const auto middle = [&](uint32_t level) {
        return svgfLevel(row, SvgfSignal::Diffuse, plane, light, level, params)[2];
    };
    EXPECT_NEAR(middle(0).x, (4.0 * 5 + 2.0 * 1 + 2.0 * 1) / 8.0, 1e-6) << "not in the first level";
    // The second level's two taps weigh 2 / 16 each, the middle 4 / 16 at most.
    const double share = std::sqrt((0.25 * 0.09 + 0.001 * 1.44) / 0.251) / 1.2;
    const double centre = 0.25 * share, sum = centre + 0.25;
    EXPECT_NEAR(middle(1).x, (centre * 5 + 0.25 * 1) / sum, 1e-6);
    EXPECT_NEAR(middle(1).w, std::sqrt(std::pow(centre * 1.2, 2) + 2 * std::pow(0.125 * 0.3, 2)) / sum, 1e-6);
    light[2].w = 0.2;
    EXPECT_NEAR(middle(1).x, (4.0 * 5 + 2.0 * 1 + 2.0 * 1) / 8.0, 1e-6) << "less noisy than its neighbours";
    light[2].w = 0.0;
    EXPECT_NEAR(middle(1).x, 5.0, 1e-6) << "without noise it resembles nothing else";
}

TEST_F(SvgfRow, NarrowKernel) {
    params.wide = false;
    const dvec4 result = svgfLevel(frame, SvgfSignal::Diffuse, surfaces, color, 0, params)[1];
    EXPECT_NEAR(result.x, (4.0 * 1 + 2.0 * 2) / 6.0, 1e-9);
    EXPECT_NEAR(result.w, std::hypot(4.0 * 0.3, 2.0 * 0.6) / 6.0, 1e-9);
}

TEST_F(SvgfRow, Normals) {
    surfaces.normal[2] = {0.6, 0, 0.8};
    params.phiNormal = 3.0;
    expectWeight(std::exp(-3.0 * 0.2));
}

TEST_F(SvgfRow, Roughness) {
    surfaces.roughness = {0.5, 0.5, 0.7};
    params.phiRoughness = 0.4;
    expectWeight(1.0);  // diffuse light has no lobe
    signal = SvgfSignal::Specular;
    expectWeight(std::exp(-0.5));
    params.phiRoughness = 0.0;
    expectWeight(1.0);
}

TEST_F(SvgfRow, Distances) {
    surfaces.distance[2] = 2.003;  // facing the viewer: 0.001 of the distance is tolerated
    expectWeight(std::exp(-1.5));
    params.phiDepth = 3.0;
    expectWeight(std::exp(-0.5));
    params.phiDepth = 1.0;
    surfaces.normal = {{0.6, 0, 0.8}, {0.6, 0, 0.8}, {0.6, 0, 0.8}};
    surfaces.distance[2] = 1.0;  // the slope is 0.6 (2/3) / 0.8 of the distance
    expectWeight(std::exp(-1.0 / (1.0 + 0.002)));
    frame.camera.orthographic = 1;  // same in world units
    expectWeight(std::exp(-1.0 / (0.5 + 0.002)));
}

TEST_F(SvgfRow, Positions) {
    params.position = true;
    params.phiNormal = 0.7;
    params.phiDepth = 2.0;
    surfaces.normal[2] = {0.6, 0, 0.8};
    const double length = std::sqrt(1 + 4.0 / 9.0), turn = std::sqrt(0.4);
    const double apart = std::hypot(2 * (2.0 / 3) / length, 2 - 2 / length);
    expectWeight(std::exp(-turn / 0.7 - apart / 2.0));
    frame.camera.orthographic = 1;
    expectWeight(std::exp(-turn / 0.7 - (2.0 / 3) / 2.0));
}

TEST_F(SvgfRow, YoungPixels) {
    params.boost = false;
    const std::vector<dvec4> moments{{7, 90, 0, 0}, {1, 2, 0, 3.5}, {2, 7, 0, 4}};
    surfaces.distance[2] = 2.003;
    const double w = std::exp(-1.5), m1 = (1 + 2 * w) / (1 + w), m2 = (2 + 7 * w) / (1 + w);
    const std::vector<dvec4> young =
        svgfYoungVariance(frame, SvgfSignal::Diffuse, surfaces, color, moments, params).color;
    EXPECT_LT(glm::distance(young[1], dvec4(1, 1, 1, std::sqrt(m2 - m1 * m1))), 1e-9);
    EXPECT_EQ(young[0], color[0]);
    EXPECT_EQ(young[2], color[2]);
}

TEST_F(SvgfRow, TheYoungerTheMoreNoiseIsExpected) {
    surfaces.distance[2] = 0.0;
    std::vector<dvec4> moments{dvec4(0), {3, 25, 0, 0}, dvec4(0)};  // a deviation of 4
    const auto young = [&](double n) {
        moments[1].w = n;
        return svgfYoungVariance(frame, SvgfSignal::Diffuse, surfaces, color, moments, params);
    };
    const double error = 49 * 0x1p-24 * 25.0;
    for (const double n : {1.0, 2.0, 2.5, 3.0, 3.75}) {
        EXPECT_NEAR(young(n).color[1].w, 8.0 / std::sqrt(n), 1e-12) << n;
        EXPECT_NEAR(young(n).error[1], 4.0 / n * error, 1e-12) << n;
    }
    EXPECT_NEAR(young(0.25).color[1].w, 8.0, 1e-12) << "less than one frame is one";
    EXPECT_EQ(young(4.0).color[1], color[1]) << "not young";
    moments[1].y = 1e9;
    EXPECT_NEAR(young(1.0).color[1].w, 2.0 * std::sqrt(1e9 - 9.0), 1e-6);
    moments[1].y = 2e9;
    EXPECT_EQ(young(1.0).color[1].w, 65504.0) << "44721 before";
    params.boost = false;
    moments[1].y = 25.0;
    for (const double n : {0.5, 1.0, 2.0, 3.0}) {
        EXPECT_NEAR(young(n).color[1].w, 4.0, 1e-12) << n;
        EXPECT_NEAR(young(n).error[1], error, 1e-12) << n;
    }
}

TEST_F(SvgfRow, YoungPixelsLeaveOutThoseWithoutAHistory) {
    surfaces.distance[2] = 2.003;
    std::vector<dvec4> moments{dvec4(0), {3, 25, 0, 1}, {90, 9000, 0, 0}};
    const auto sigma = [&](size_t p) {
        return svgfYoungVariance(frame, SvgfSignal::Diffuse, surfaces, color, moments, params).color[p].w;
    };
    EXPECT_NEAR(sigma(1), 8.0, 1e-12) << "the centre alone";
    EXPECT_NEAR(sigma(2), 8.0, 1e-12) << "the neighbour alone, however small its weight";
    moments[2] = {5, 29, 0, 0.5};  // a deviation of 2
    moments[1].w = 0.0;
    EXPECT_NEAR(sigma(1), 4.0, 1e-12);
    moments[2].w = 0.0;
    EXPECT_EQ(sigma(1), 0.0);
    EXPECT_EQ(sigma(2), 0.0);
    params.boost = false;
    EXPECT_EQ(sigma(1), 0.0);
}

TEST_F(SvgfRow, WeightsThatFloatsMayLoseAreNotCompared) {
    surfaces.distance[2] = 2.2;  // exp(-100)
    const std::vector<dvec4> moments{dvec4(0), dvec4(0), {3, 25, 0, 1}};
    const std::vector<double> error =
        svgfYoungVariance(frame, SvgfSignal::Diffuse, surfaces, color, moments, params).error;
    EXPECT_TRUE(std::isinf(error[1]));
    EXPECT_FALSE(std::isinf(error[2]));
}

}  // namespace
}  // namespace limpid::test
