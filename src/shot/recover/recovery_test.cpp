// Tests Recovery with pictures whose truth is known: noise stays out, what the filter got wrong comes back.
#include "shot/recover/recovery.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "shot/recover/box_means.h"

namespace limpid::shot {
namespace {

using denoise::HostFrame;
using image::Image;

constexpr uint32_t width = 72, height = 64;
using Picture = std::function<float(int x, int y)>;

/// Surfaces that face the viewer; motion and distance by pixel.
HostFrame guides(
    float motionX = 0.0f, const Picture& distance = [](int, int) { return 2.0f; }) {
    HostFrame frame;
    frame.width = width;
    frame.height = height;
    for (uint32_t p = 0; p < width * height; ++p) {
        const auto x = static_cast<int>(p % width), y = static_cast<int>(p / width);
        frame.depth.insert(frame.depth.end(), {distance(x, y), 1.0f, 0.0f, 0.0f});
        frame.normal.insert(frame.normal.end(), {0.0f, 0.0f, 1.0f, 0.0f});
        frame.motion.insert(frame.motion.end(), {motionX, 0.0f, 0.0f, 1.0f});
    }
    return frame;
}

std::vector<float> rgba(const Picture& picture) {
    std::vector<float> result;
    for (uint32_t p = 0; p < width * height; ++p) {
        const float value = picture(static_cast<int>(p % width), static_cast<int>(p / width));
        result.insert(result.end(), {value, value, value, 0.5f});
    }
    return result;
}

Image noisyPicture(const Picture& picture, float deviation, uint32_t seed) {
    Image result(width, height, 3);
    std::mt19937 random(seed);
    std::normal_distribution<float> noise(0.0f, deviation);
    for (uint32_t p = 0; p < width * height; ++p)
        for (uint32_t c = 0; c < 3; ++c)
            result.pixels[3 * p + c] =
                picture(static_cast<int>(p % width), static_cast<int>(p / width)) + noise(random);
    return result;
}

/// The root of the mean squared error of the pixels that `counts` chooses.
double error(
    const std::vector<float>& picture, const Picture& truth,
    const std::function<bool(int x, int y)>& counts = [](int, int) { return true; }) {
    double sum = 0.0, count = 0.0;
    for (uint32_t p = 0; p < width * height; ++p) {
        const auto x = static_cast<int>(p % width), y = static_cast<int>(p / width);
        if (!counts(x, y)) continue;
        for (uint32_t c = 0; c < 3; ++c) sum += std::pow(picture[4 * p + c] - truth(x, y), 2.0);
        count += 3.0;
    }
    return std::sqrt(sum / count);
}

const Picture evenPicture = [](int, int) { return 1.0f; };

TEST(Recovery, NoiseStaysOut) {
    Recovery recovery;
    std::vector<float> clean;
    double sum = 0.0;
    for (uint32_t frame = 0; frame < 6; ++frame) {
        clean = rgba(evenPicture);
        recovery.apply(clean, noisyPicture(evenPicture, 0.3f, frame), guides(), 4, frame > 0);
        for (size_t i = 0; i < clean.size(); i += 4) sum += clean[i];
    }
    EXPECT_LT(error(clean, evenPicture), 0.03);
    EXPECT_NEAR(sum / (6.0 * width * height), 1.0, 0.003) << "the mean stays";
    EXPECT_EQ(clean[3], 0.5f) << "alpha stays";
}

TEST(Recovery, DetailComesBack) {
    const Picture squares = [](int x, int y) { return (x / 4 + y / 4) % 2 == 0 ? 1.5f : 0.5f; };
    Recovery recovery;
    std::vector<float> clean;
    for (uint32_t frame = 0; frame < 4; ++frame) {
        clean = rgba(evenPicture);
        recovery.apply(clean, noisyPicture(squares, 0.1f, frame), guides(), 64, frame > 0);
    }
    EXPECT_LT(error(clean, squares), 0.2) << "it was 0.5";
}

/// A shadow that the filter has missed, in noise twice as large.
TEST(Recovery, SmoothErrorsComeBackWithoutTheNoise) {
    const auto isShadow = [](int x, int y) { return std::hypot(x - 36, y - 32) < 14.0; };
    const Picture shadow = [&](int x, int y) { return isShadow(x, y) ? 0.5f : 1.0f; };
    Recovery recovery;
    std::vector<float> clean = rgba(evenPicture);
    recovery.apply(clean, noisyPicture(shadow, 0.5f, 1), guides(), 4, false);
    const auto within = [](int x, int y) { return std::hypot(x - 36, y - 32) < 10.0; };
    const auto outside = [](int x, int y) { return std::hypot(x - 36, y - 32) > 20.0; };
    EXPECT_LT(error(clean, shadow, within), 0.25) << "it was 0.5";
    EXPECT_LT(error(clean, shadow, outside), 0.08);
}

/// The column between two surfaces shows half of each.
const Picture edge = [](int x, int) { return x < 40 ? 1.0f : x == 40 ? 0.6f : 0.2f; };
const Picture distance = [](int x, int) { return x <= 40 ? 2.0f : 5.0f; };
bool isColumn(int x, int) {
    return x == 40;
}

TEST(Recovery, EdgesComeBack) {
    Recovery recovery;
    std::vector<float> clean = rgba([](int x, int) { return x <= 40 ? 1.0f : 0.2f; });
    recovery.apply(clean, noisyPicture(edge, 0.02f, 1), guides(0.0f, distance), 64, false);
    EXPECT_LT(error(clean, edge, isColumn), 0.1) << "it was 0.4";
    EXPECT_LT(error(clean, edge, [](int x, int) { return x < 35 || x > 45; }), 0.01);
}

/// A sample sees one of the surfaces.
TEST(Recovery, NoiseOfEdgesStaysOut) {
    std::mt19937 random(5);
    const Picture sample = [&](int x, int y) {
        return isColumn(x, y) ? (random() % 2 == 0 ? 1.0f : 0.2f) : edge(x, y);
    };
    Recovery recovery;
    std::vector<float> clean = rgba(edge);
    recovery.apply(clean, noisyPicture(sample, 0.02f, 1), guides(0.0f, distance), 1, false);
    EXPECT_LT(error(clean, edge, isColumn), 0.1) << "0.4 in the noisy picture";
}

/// Neighbours of single pixels in a checkerboard say the contrary; only the frame before knows it.
TEST(Recovery, FollowsMotion) {
    const auto board = [](int frame) {
        return Picture([frame](int x, int y) { return (x + y + 3 * frame) % 2 == 0 ? 1.4f : 0.6f; });
    };
    for (const float motion : {-3.0f, 0.0f}) {
        Recovery recovery;
        std::vector<float> clean;
        for (int frame = 0; frame < 8; ++frame) {
            clean = rgba(evenPicture);
            recovery.apply(clean, noisyPicture(board(frame), 0.1f, static_cast<uint32_t>(frame)),
                           guides(motion), 64, frame > 0);
        }
        const double left = error(clean, board(7), [](int x, int) { return x > 40; });
        if (motion == 0.0f)
            EXPECT_GT(left, 0.35) << "the wrong motion tells nothing";
        else
            EXPECT_LT(left, 0.2) << "it was 0.4";
    }
}

TEST(Recovery, WhatIsNotFiniteStaysOut) {
    Image bad = noisyPicture(evenPicture, 0.1f, 1);
    bad.pixels[3 * (30 * width + 30)] = NAN;
    bad.pixels[3 * (40 * width + 30)] = INFINITY;
    Recovery recovery;
    for (int frame = 0; frame < 2; ++frame) {
        std::vector<float> clean = rgba(evenPicture);
        recovery.apply(clean, bad, guides(), 4, frame > 0);
        for (const float value : clean) ASSERT_TRUE(std::isfinite(value) && value >= 0.0f);
        EXPECT_LT(error(clean, evenPicture), 0.15);
    }
}

TEST(BoxMeans, AreThoseOfTheirDefinition) {
    Image picture(13, 9, 3);
    std::mt19937 random(1);
    for (float& value : picture.pixels) value = std::uniform_real_distribution<float>(0.0f, 1.0f)(random);
    for (const int radius : {0, 1, 3, 20}) {
        const Image means = boxMeans(picture, static_cast<uint32_t>(radius));
        for (int y = 0; y < 9; ++y)
            for (int x = 0; x < 13; ++x)
                for (uint32_t c = 0; c < 3; ++c) {
                    double sum = 0.0;
                    for (int j = -radius; j <= radius; ++j)
                        for (int i = -radius; i <= radius; ++i)
                            sum += picture.at(static_cast<uint32_t>(std::clamp(x + i, 0, 12)),
                                              static_cast<uint32_t>(std::clamp(y + j, 0, 8)), c);
                    ASSERT_NEAR(means.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y), c),
                                sum / std::pow(2.0 * radius + 1.0, 2.0), 1e-5);
                }
    }
}

}  // namespace
}  // namespace limpid::shot
