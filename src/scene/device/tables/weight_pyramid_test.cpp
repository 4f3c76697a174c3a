// Tests tables of weights: going down the levels chooses each entry with its probability, whatever the size.
#include "scene/device/tables/weight_pyramid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace limpid::scene {
namespace {

std::vector<double> randomWeights(size_t count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<double> weights(count);
    for (double& weight : weights)
        weight = uniform(random) < 0.3 ? 0.0 : std::pow(10.0, 6.0 * uniform(random));
    return weights;
}

double sumOf(const vec4& record) {
    return double{record.x} + double{record.y} + double{record.z} + double{record.w};
}

/// The probability of a texel by the records that lead to it.
double chanceOf(const WeightPyramid& pyramid, uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
    uint32_t levels = 0;
    while ((1u << levels) < std::max(width, height)) ++levels;
    double chance = 1.0;
    size_t first = 0;
    for (uint32_t level = levels; level > 0; --level) {
        const uint32_t columns = (width - 1) / (1u << level) + 1, rows = (height - 1) / (1u << level) + 1;
        const vec4& record = pyramid.records.at(first + size_t{y >> level} * columns + (x >> level));
        const auto part = static_cast<int>(((x >> (level - 1)) & 1u) + 2 * ((y >> (level - 1)) & 1u));
        chance *= double{record[part]} / sumOf(record);
        first += size_t{columns} * rows;
    }
    EXPECT_EQ(first, pyramid.records.size());
    return chance;
}

double chanceOf(const WeightPyramid& pyramid, uint32_t index, uint32_t count) {
    uint32_t levels = 0;
    while ((uint64_t{1} << (2 * levels)) < count) ++levels;
    double chance = 1.0;
    size_t first = 0;
    for (uint32_t level = levels; level > 0; --level) {
        const vec4& record = pyramid.records.at(first + (index >> (2 * level)));
        chance *= double{record[static_cast<int>((index >> (2 * level - 2)) & 3u)]} / sumOf(record);
        first += (count - 1) / (1u << (2 * level)) + 1;
    }
    EXPECT_EQ(first, pyramid.records.size());
    return chance;
}

TEST(WeightPyramidTest, ChoosesTexelsByWeight) {
    struct Size {
        uint32_t width, height;
    };
    for (const Size size :
         {Size{1, 1}, Size{2, 1}, Size{1, 3}, Size{4, 4}, Size{7, 5}, Size{48, 24}, Size{33, 2}}) {
        const std::vector<double> weights = randomWeights(size_t{size.width} * size.height);
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
        const WeightPyramid pyramid = buildWeightPyramid(weights, size.width, size.height);
        for (uint32_t y = 0; y < size.height; ++y) {
            for (uint32_t x = 0; x < size.width; ++x) {
                const size_t at = size_t{y} * size.width + x;
                const double wanted = sum > 0.0 ? weights[at] / sum : 1.0;
                ASSERT_NEAR(double{pyramid.probabilities[at]}, wanted, 1e-6 * wanted);
                if (wanted == 0.0) continue;  // no record need lead there
                ASSERT_NEAR(chanceOf(pyramid, x, y, size.width, size.height), wanted, 3e-6 * wanted)
                    << size.width << "x" << size.height << " at " << x << ", " << y;
            }
        }
    }
}

TEST(WeightPyramidTest, ChoosesEntriesOfAListByWeight) {
    for (const uint32_t count : {1u, 2u, 3u, 4u, 5u, 16u, 17u, 1000u}) {
        const std::vector<double> weights = randomWeights(count);
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
        const WeightPyramid pyramid = buildWeightPyramid(weights);
        for (uint32_t i = 0; i < count && sum > 0.0; ++i) {
            const double wanted = weights[i] / sum;
            ASSERT_NEAR(double{pyramid.probabilities[i]}, wanted, 1e-6 * wanted);
            if (wanted == 0.0) continue;
            ASSERT_NEAR(chanceOf(pyramid, i, count), wanted, 3e-6 * wanted) << i << " of " << count;
        }
    }
}

TEST(WeightPyramidTest, WithoutAnyWeightAllAreAsProbable) {
    const WeightPyramid picture = buildWeightPyramid(std::vector<double>(15), 5, 3);
    for (uint32_t x = 0; x < 5; ++x) EXPECT_NEAR(chanceOf(picture, x, 2, 5, 3), 1.0 / 15.0, 1e-7);
    EXPECT_NEAR(chanceOf(buildWeightPyramid(std::vector<double>(6)), 5, 6), 1.0 / 6.0, 1e-7);
    EXPECT_TRUE(buildWeightPyramid({}).records.empty());
    EXPECT_TRUE(buildWeightPyramid({2.0}).records.empty());
}

}  // namespace
}  // namespace limpid::scene
