#include "image/metrics/flicker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "base/error.h"
#include "image/metrics/metrics.h"

namespace limpid::image {
namespace {

constexpr float missDepth = 1e10f;

Image noise(uint32_t width, uint32_t height, unsigned seed, float mean, float sigma) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal(mean, sigma);
    Image image(width, height, 3);
    for (float& v : image.pixels) v = normal(random);
    return image;
}

/// Returns the part of `world` whose upper left corner is at (x, y).
Image view(const Image& world, uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
    Image image(width, height, world.components);
    for (uint32_t j = 0; j < height; ++j) {
        for (uint32_t i = 0; i < width; ++i) {
            for (uint32_t c = 0; c < world.components; ++c) image.at(i, j, c) = world.at(x + i, y + j, c);
        }
    }
    return image;
}

Geometry moving(uint32_t width, uint32_t height, float x, float y) {
    Geometry geometry;
    geometry.motion = Image(width, height, 2, x);
    for (size_t i = 1; i < geometry.motion->pixels.size(); i += 2) geometry.motion->pixels[i] = y;
    return geometry;
}

Image plus(Image image, float offset) {
    for (float& v : image.pixels) v += offset;
    return image;
}

TEST(Flicker, OfAlternatingNoiseIsTwiceItsAmplitude) {
    const Image reference(30, 20, 3, 0.5f);
    Image even = reference, odd = reference;
    std::mt19937 random(1);
    for (size_t i = 0; i < even.pixels.size(); ++i) {
        const float sign = random() % 2 ? 1.0f : -1.0f;
        even.pixels[i] += 0.125f * sign;
        odd.pixels[i] -= 0.125f * sign;
    }
    EXPECT_EQ(flicker(odd, even, reference, reference, stillReprojection(30, 20)), 0.25);
    EXPECT_EQ(flicker(even, even, reference, reference, stillReprojection(30, 20)), 0.0)
        << "noise that stays";
}

TEST(Flicker, OfIndependentGaussianNoise) {
    // The difference of two pixels is Gaussian with sigma * sqrt(2), so its mean absolute value is
    // 2 sigma / sqrt(pi).
    const double sigma = 0.05, want = 2.0 * sigma / std::sqrt(std::numbers::pi);
    const Image reference(200, 200, 3, 0.5f);
    const auto found = flicker(noise(200, 200, 1, 0.5f, 0.05f), noise(200, 200, 2, 0.5f, 0.05f), reference,
                               reference, stillReprojection(200, 200));
    const double deviation = std::sqrt(2.0) * sigma * std::sqrt(1.0 - 2.0 / std::numbers::pi);
    EXPECT_NEAR(*found, want, 5.0 * deviation / std::sqrt(200.0 * 200.0 * 3.0));
}

TEST(Flicker, APictureThatMovesWithItsMotionHasNone) {
    const Image world = noise(60, 50, 3, 0.5f, 0.2f);
    // The window moves 3 to the right and 2 up, so its content was 3 further right and 2 further up before.
    const Image before = view(world, 10, 10, 40, 30), now = view(world, 13, 8, 40, 30);
    const Reprojection r = reproject(moving(40, 30, 3.0f, -2.0f), {});
    EXPECT_EQ(r.used, 37u * 28u) << "what came into view is excluded";
    EXPECT_EQ(temporalChange(now, before, r), 0.0);
    EXPECT_GT(*temporalChange(now, before, stillReprojection(40, 30)), 0.1)
        << "without motion it would not be";
    EXPECT_GT(*temporalChange(now, before, reproject(moving(40, 30, -3.0f, 2.0f), {})), 0.1)
        << "nor backwards";
}

TEST(Flicker, BetweenPixelsIsBilinear) {
    // A ramp along x and y moves by a fraction of a pixel. Bilinear interpolation is exact, except in the
    // first half pixel, where the border is repeated and the value is off by a quarter of a step.
    const uint32_t width = 32, height = 16;
    Image before(width, height, 3), now = before;
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
            for (uint32_t c = 0; c < 3; ++c) {
                before.at(x, y, c) = 0.02f * static_cast<float>(x) + 0.01f * static_cast<float>(y);
                now.at(x, y, c) = before.at(x, y, c) - 0.02f * 0.25f;
            }
        }
    }
    const Reprojection r = reproject(moving(width, height, -0.25f, 0.0f), {});
    EXPECT_EQ(r.used, size_t{width} * height);
    EXPECT_NEAR(*temporalChange(now, before, r), 0.02 * 0.25 / width, 1e-7);
}

TEST(Flicker, AConstantErrorHasNone) {
    const Image world = noise(60, 50, 4, 0.5f, 0.05f);
    const Image before = view(world, 5, 5, 40, 30), now = view(world, 7, 5, 40, 30);
    const Image testBefore = plus(before, 0.1f), testNow = plus(now, 0.1f);
    const auto found = flicker(testNow, testBefore, now, before, reproject(moving(40, 30, 2.0f, 0.0f), {}));
    EXPECT_NEAR(*found, 0.0, 1e-7);
    EXPECT_NEAR(psnr(testNow, now), 20.0, 1e-3);
}

TEST(TemporalError, NoiseAndLagCountAlike) {
    const Image dark(8, 8, 3, 0.25f), bright(8, 8, 3, 0.5f), steady(8, 8, 3, 0.375f);
    const Reprojection still = stillReprojection(8, 8);
    EXPECT_EQ(temporalError(bright, dark, bright, dark, still), 0.0) << "a light that is switched on";
    EXPECT_EQ(temporalError(dark, dark, bright, dark, still), 0.25) << "the test lags behind";
    EXPECT_EQ(temporalError(bright, dark, steady, steady, still), 0.25) << "the test is not steady";
    EXPECT_EQ(temporalError(bright, bright, dark, dark, still), 0.0) << "a constant error";
    Image half = steady;  // noise in one half of the picture, lag in the other: they do not cancel
    std::fill_n(half.pixels.begin(), half.pixels.size() / 2, 0.25f);
    Image reference = steady;
    std::fill(reference.pixels.begin() + static_cast<std::ptrdiff_t>(reference.pixels.size() / 2),
              reference.pixels.end(), 0.25f);
    EXPECT_EQ(flicker(half, steady, reference, steady, still), 0.0);
    EXPECT_EQ(temporalError(half, steady, reference, steady, still), 0.125);
}

TEST(Flicker, OfTheReferenceIsSubtracted) {
    const Image dark(8, 8, 3, 0.25f), bright(8, 8, 3, 0.5f);
    const Reprojection still = stillReprojection(8, 8);
    EXPECT_EQ(flicker(bright, dark, bright, dark, still), 0.0) << "a light that is switched on";
    EXPECT_EQ(flicker(dark, dark, bright, dark, still), -0.25)
        << "the test lags behind: steadier than the truth";
}

TEST(Flicker, PixelsWithoutAPlaceBeforeDoNotCount) {
    const uint32_t width = 8, height = 1;
    Geometry geometry = moving(width, height, 0.0f, 0.0f);
    const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
    const std::vector<float> marks = {invalidMotion, nan, infinity, -8.0f, 2e6f};
    for (uint32_t x = 0; x < marks.size(); ++x) geometry.motion->at(x, 0, x % 2) = marks[x];
    geometry.motion->at(5, 0, 1) = 0.6f;  // below the only row
    const Reprojection r = reproject(geometry, {});
    EXPECT_EQ(r.used, 2u);
    Image now(width, height, 3, 1.0f), before(width, height, 3, 0.0f);
    for (uint32_t c = 0; c < 3; ++c) now.at(6, 0, c) = 0.25f, now.at(7, 0, c) = 0.75f;
    EXPECT_EQ(temporalChange(now, before, r), 0.5) << "only the last two count";
    EXPECT_EQ(temporalChange(now, before, reproject(moving(width, height, invalidMotion, invalidMotion), {})),
              std::nullopt);
    EXPECT_EQ(flicker(now, before, now, before, reproject(moving(width, height, nan, nan), {})),
              std::nullopt);
}

/// Returns a row of pixels: a box at distance 4 from `box` to `box` + 2, elsewhere a wall at distance 10. In
/// the previous frame the box was `boxMotion` pixels further right and 1 further away. The wall is static.
Geometry boxBeforeWall(uint32_t box, float boxMotion) {
    Geometry g = moving(10, 1, 0.0f, 0.0f);
    g.distanceChange = Image(10, 1, 1, 0.0f);
    g.depth = Image(10, 1, 1, 10.0f);
    for (uint32_t x = box; x < box + 3; ++x) {
        g.motion->at(x, 0, 0) = boxMotion;
        g.distanceChange->at(x, 0, 0) = 1.0f;
        g.depth->at(x, 0, 0) = 4.0f;
    }
    return g;
}

TEST(Flicker, DepthFindsWhatWasHidden) {
    // The box was at 5..7 (and 5 away), and is at 3..5 (4 away): 6 and 7 show the wall that it hid.
    Geometry before = boxBeforeWall(5, 0.0f);
    for (uint32_t x = 5; x < 8; ++x) before.depth->at(x, 0, 0) = 5.0f;
    Geometry now = boxBeforeWall(3, 2.0f);
    const Reprojection r = reproject(now, before);
    EXPECT_EQ(r.used, 8u);
    EXPECT_EQ(r.sources[6].shares, (std::array<float, 4>{}));
    EXPECT_EQ(r.sources[7].shares, (std::array<float, 4>{}));
    now.distanceChange.reset();
    EXPECT_EQ(reproject(now, before).used, 10u) << "without the change of distance there is nothing to test";
    now = boxBeforeWall(3, 2.0f);
    now.depth->at(0, 0, 0) = std::nanf("");
    EXPECT_EQ(reproject(now, before).used, 7u) << "a depth that is none matches nothing";
}

TEST(Flicker, NormalsFindWhatWasHidden) {
    Geometry now = moving(3, 1, 0.0f, 0.0f), before;
    now.normal = Image(3, 1, 3);
    before.normal = Image(3, 1, 3);
    now.normal->pixels = {0, 0, 1, 0, 0.5f, 0.4f, 0, 0, 0};
    before.normal->pixels = {0, 1, 0, 0, 0, 0.3f, 0, 0, 0};
    Reprojection r = reproject(now, before);
    EXPECT_EQ(r.used, 1u) << "a right angle, 51 degrees, and two misses, which are alike";
    EXPECT_EQ(r.sources[2].shares[0], 1.0f);
    now.normal->pixels[4] = 0.35f;
    EXPECT_EQ(reproject(now, before).used, 2u) << "41 degrees";
    before.normal->pixels[8] = 1.0f;
    EXPECT_EQ(reproject(now, before).used, 1u) << "a hit and a miss are not alike";
}

TEST(Flicker, MissesStayMisses) {
    Geometry sky = moving(4, 4, 1.0f, 0.0f);
    sky.distanceChange = Image(4, 4, 1, 0.0f);
    sky.depth = Image(4, 4, 1, missDepth);
    EXPECT_EQ(reproject(sky, sky).used, 12u);
}

TEST(Flicker, OfFourPixelsThoseOfTheSurfaceShare) {
    // Rounding moves a resting edge by a hair: what lies beyond the edge must not bleed in, nor exclude.
    Geometry g = moving(4, 1, 1e-5f, 0.0f);
    g.distanceChange = Image(4, 1, 1, 0.0f);
    g.depth = Image(4, 1, 1, 2.0f);
    g.depth->at(2, 0, 0) = g.depth->at(3, 0, 0) = 50.0f;
    Image picture(4, 1, 3, 0.0f);
    for (uint32_t c = 0; c < 3; ++c) picture.at(2, 0, c) = picture.at(3, 0, c) = 1.0f;
    Reprojection r = reproject(g, g);
    EXPECT_EQ(r.used, 4u);
    EXPECT_EQ(temporalChange(picture, picture, r), 0.0);
    // Half way between: the near side of the edge takes all of it.
    g.motion = moving(4, 1, 0.5f, 0.0f).motion;
    EXPECT_EQ(temporalChange(picture, picture, reproject(g, g)), 0.0);
}

TEST(Flicker, RefusesWhatDoesNotFit) {
    EXPECT_THROW(reproject({}, {}), Error);
    Geometry small;
    small.depth = Image(2, 2, 1);
    EXPECT_THROW(reproject(moving(3, 2, 0, 0), small), Error);
    EXPECT_THROW(temporalChange(Image(3, 2, 3), Image(2, 2, 3), stillReprojection(3, 2)), Error);
    EXPECT_THROW(temporalChange(Image(3, 2, 1), Image(3, 2, 1), stillReprojection(3, 2)), Error);
}

}  // namespace
}  // namespace limpid::image
