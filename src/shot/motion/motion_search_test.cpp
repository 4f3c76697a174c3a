// Tests the motion that is found, on patterns with known shifts.
#include "shot/motion/motion_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "shot/frame/pixel_layers.h"

namespace limpid::shot {
namespace {

constexpr uint32_t wide = 160, tall = 96;

/// Albedo (red) and the x of the normal at a place, which may lie between pixels.
using Look = std::function<vec2(float x, float y)>;

ShotLayers layersOf(const Look& look) {
    ShotLayers layers;
    layers.width = wide;
    layers.height = tall;
    image::Image albedo(wide, tall, 3), normal(wide, tall, 3);
    for (uint32_t y = 0; y < tall; ++y)
        for (uint32_t x = 0; x < wide; ++x) {
            const vec2 seen = look(static_cast<float>(x), static_cast<float>(y));
            const size_t p = 3 * (size_t{y} * wide + x);
            albedo.pixels[p] = seen.x;
            albedo.pixels[p + 1] = 0.5f * seen.x;
            normal.pixels[p] = seen.y;
            normal.pixels[p + 2] = std::sqrt(std::max(1.0f - seen.y * seen.y, 0.0f));
        }
    layers.images["albedo"] = albedo;
    layers.images["normal"] = normal;
    return layers;
}

/// Random values at every fifth pixel, smoothly interpolated: nowhere like elsewhere.
float pattern(float x, float y) {
    const auto value = [](float i, float j) {
        const auto seed = static_cast<uint32_t>(static_cast<int>(i) * 7919 + static_cast<int>(j) * 104729);
        const uint32_t mixed = (seed ^ (seed >> 15u)) * 2246822519u;
        return static_cast<float>((mixed ^ (mixed >> 13u)) * 3266489917u >> 8u) / 16777216.0f;
    };
    const float i = std::floor(x / 5.0f), j = std::floor(y / 5.0f);
    const auto smooth = [](float t) { return t * t * (3.0f - 2.0f * t); };
    const float u = smooth(x / 5.0f - i), v = smooth(y / 5.0f - j);
    return 0.2f + 0.6f * glm::mix(glm::mix(value(i, j), value(i + 1, j), u),
                                  glm::mix(value(i, j + 1), value(i + 1, j + 1), u), v);
}

ShotLayers zeroMotionOf(const Look& look) {
    ShotLayers layers = layersOf(look);
    layers.zeroMotion = true;
    return layers;
}

vec2 texture(float x, float y) {
    return {pattern(x, y), 0.0f};
}

image::Image motionBetween(const Look& before, const Look& now) {
    MotionSearch search;
    EXPECT_FALSE(search.next(layersOf(before), true)) << "nothing came before";
    return search.next(layersOf(now), true).value();
}

/// The share of pixels in a rectangle whose motion is certain and within `tolerance` of `expected`.
double shareNear(const image::Image& motion, const vec2& expected, float tolerance, uint32_t left = 8,
                 uint32_t top = 8, uint32_t right = wide - 8, uint32_t bottom = tall - 8) {
    size_t near = 0, all = 0;
    for (uint32_t y = top; y < bottom; ++y)
        for (uint32_t x = left; x < right; ++x) {
            ++all;
            near +=
                glm::distance(vec2(motion.at(x, y, 0), motion.at(x, y, 1)), expected) <= tolerance ? 1 : 0;
        }
    return static_cast<double>(near) / static_cast<double>(all);
}

double shareUncertain(const image::Image& motion) {
    return shareNear(motion, vec2(MotionSearch::uncertain), 0.0f);
}

TEST(MotionSearchTest, EqualFramesHaveNoMotion) {
    const image::Image motion = motionBetween(texture, texture);
    for (const float value : motion.pixels) ASSERT_EQ(value, 0.0f);
    const auto flat = [](float, float) { return vec2(0.5f, 0.0f); };
    for (const float value : motionBetween(flat, flat).pixels) ASSERT_EQ(value, 0.0f);
}

/// What was at (x, y) is now at (x, y) - shift.
TEST(MotionSearchTest, ShiftsAreFoundToAFractionOfAPixel) {
    for (const vec2 shift :
         {vec2(3, -2), vec2(-11, 7), vec2(0.5f, 0), vec2(2.5f, -1.5f), vec2(-0.25f, 0.75f)}) {
        const auto now = [&](float x, float y) { return texture(x + shift.x, y + shift.y); };
        const image::Image motion = motionBetween(texture, now);
        EXPECT_GT(shareNear(motion, shift, 0.25f, 16, 16, wide - 16, tall - 16), 0.97)
            << shift.x << " " << shift.y;
        EXPECT_GT(shareNear(motion, shift, 0.13f, 16, 16, wide - 16, tall - 16), 0.8)
            << shift.x << " " << shift.y;
    }
}

TEST(MotionSearchTest, WhatLeavesThePictureIsUncertain) {
    const image::Image motion = motionBetween(texture, [](float x, float y) { return texture(x - 12, y); });
    for (uint32_t y = 8; y < tall - 8; ++y)
        EXPECT_EQ(motion.at(2, y, 0), MotionSearch::uncertain) << "it came in from the left";
}

/// A square of 40x40 pixels with another normal moves to the right before a background that moves down.
TEST(MotionSearchTest, ObjectsMoveDifferentlyAndUncoverWhatIsBehind) {
    const auto scene = [](float left, float down) {
        return [=](float x, float y) {
            const bool square = x >= left && x < left + 40 && y >= 28 && y < 68;
            return square ? vec2(pattern(2 * (x - left) + 500, 2 * y + 300), 0.7f)
                          : vec2(pattern(x, y - down), 0.0f);
        };
    };
    const image::Image motion = motionBetween(scene(50, 0), scene(58, 3));
    EXPECT_GT(shareNear(motion, vec2(-8, 0), 0.3f, 63, 33, 93, 63), 0.95);
    EXPECT_GT(shareNear(motion, vec2(0, -3), 0.3f, 110, 12, 150, 84), 0.95);
    EXPECT_GT(shareNear(motion, vec2(0, -3), 0.3f, 8, 12, 40, 84), 0.95);
    // The eight columns that the square has uncovered, but for those next to edges.
    EXPECT_GT(shareNear(motion, vec2(MotionSearch::uncertain), 0.0f, 52, 34, 56, 62), 0.8);
}

/// In the middle is a wall without texture; it moves as what hangs around it.
TEST(MotionSearchTest, FlatSurfacesMoveAsTheirSurroundings) {
    const auto wall = [](float x, float y) {
        return std::abs(x - 80) < 30 && std::abs(y - 48) < 24 ? vec2(0.5f, 0.0f) : texture(x, y);
    };
    for (const vec2 shift : {vec2(4, -3), vec2(1.5f, 0.5f)}) {
        const image::Image motion =
            motionBetween(wall, [&](float x, float y) { return wall(x + shift.x, y + shift.y); });
        EXPECT_GT(shareNear(motion, shift, 0.3f, 58, 32, 102, 64), 0.95);
    }
}

/// A camera that moves forward: motion grows from the middle.
TEST(MotionSearchTest, AZoomIsSmooth) {
    const image::Image motion = motionBetween(
        texture, [](float x, float y) { return texture(80 + 0.95f * (x - 80), 48 + 0.95f * (y - 48)); });
    size_t near = 0, all = 0;
    for (uint32_t y = 8; y < tall - 8; ++y)
        for (uint32_t x = 8; x < wide - 8; ++x) {
            const vec2 expected = -0.05f * (vec2(x, y) - vec2(80, 48));
            ++all;
            near += glm::distance(vec2(motion.at(x, y, 0), motion.at(x, y, 1)), expected) < 0.3f ? 1 : 0;
        }
    EXPECT_GT(static_cast<double>(near), 0.95 * static_cast<double>(all));
}

TEST(MotionSearchTest, NothingIsFoundAcrossACutOrWithoutGuides) {
    const auto other = [](float x, float y) { return vec2(1.0f - pattern(1.7f * y + 90, 2.1f * x), 0.9f); };
    EXPECT_GT(shareUncertain(motionBetween(texture, other)), 0.95);
    MotionSearch search;
    search.next(layersOf(texture), false);
    EXPECT_FALSE(search.next(layersOf(texture), false)) << "the caller knows of a cut";
    EXPECT_TRUE(search.next(layersOf(texture), true));
    ShotLayers small = layersOf(texture);
    small.width /= 2;
    for (auto& [role, image] : small.images) image = image::Image(wide / 2, tall, 3, 0.5f);
    EXPECT_FALSE(search.next(small, true)) << "another size";
    small.images.clear();
    search.next(small, true);
    EXPECT_FALSE(search.next(small, true));
}

/// Layers of few samples are noisy at edges: motion must not follow that noise.
TEST(MotionSearchTest, NoiseInAStillFrameIsNoMotion) {
    uint32_t state = 1;
    const auto noisy = [&](float x, float y) {
        state = state * 1664525u + 1013904223u;
        const float noise = static_cast<float>(state >> 8u) / 16777216.0f - 0.5f;
        return vec2(pattern(x, y) + 0.2f * noise, 0.0f);
    };
    EXPECT_GT(shareNear(motionBetween(noisy, noisy), vec2(0), 0.26f), 0.9);
    MotionSearch search;
    for (int frame = 0; frame < 3; ++frame) {
        ShotLayers layers = zeroMotionOf(noisy);
        search.replaceZero(layers, {}, frame > 0);
        EXPECT_FALSE(layers.motionSearched || layers.zeroMotion);
        for (const float value : layers.find("motion")->pixels) ASSERT_EQ(value, 0.0f);
    }
}

TEST(MotionSearchTest, VectorsThatAreAllZeroAreReplacedIfThePictureChanges) {
    Encoding encoding;
    encoding.motionUnit = MotionUnit::Picture;
    encoding.motionScale = {-0.5f, 0.5f};
    for (const vec2 shift : {vec2(3, -2), vec2(0.5f, 0)}) {
        MotionSearch search;
        ShotLayers first = zeroMotionOf(texture);
        search.replaceZero(first, encoding, false);
        EXPECT_EQ(first.find("motion")->at(20, 20, 0), 0.0f) << "nothing is known yet";
        ShotLayers layers = zeroMotionOf([&](float x, float y) { return texture(x + shift.x, y + shift.y); });
        search.replaceZero(layers, encoding, true);
        ASSERT_TRUE(layers.motionSearched);
        EXPECT_EQ(layers.problems.size(), 1u);
        const auto moved = motionAt(*layers.find("motion"), 48 * wide + 80, encoding);
        ASSERT_TRUE(moved);
        EXPECT_LT(glm::distance(*moved, shift), 0.25f) << shift.x;
        ShotLayers afterCut = zeroMotionOf(texture);
        search.replaceZero(afterCut, encoding, false);
        EXPECT_FALSE(afterCut.find("motion")) << "the vectors are not believed any more";
    }
}

TEST(MotionSearchTest, FramesGetMotionInPlaceOfZeros) {
    FrameConverter converter{LayerMap()};
    const auto convert = [&](float shift, bool continues) {
        ShotLayers layers = zeroMotionOf([&](float x, float y) { return texture(x + shift, y); });
        layers.images["beauty"] = image::Image(wide, tall, 3, 1.0f);
        return converter.convertUsingUp(layers, std::nullopt, continues, false);
    };
    convert(0.0f, false);
    EXPECT_FALSE(converter.report().motionSearched);
    const denoise::HostFrame frame = convert(4.0f, true);
    EXPECT_TRUE(converter.report().motionSearched);
    EXPECT_EQ(converter.report().problems.size(), 1u);
    EXPECT_EQ(converter.report().camera, CameraSource::Supposed);
    const float* const moved = &frame.motion[4 * (48 * wide + 80)];
    EXPECT_NEAR(moved[0], 4.0f, 0.25f);
    EXPECT_EQ(moved[3], 1.0f);
}

}  // namespace
}  // namespace limpid::shot
