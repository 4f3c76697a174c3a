#include "renderer/long/sums/accumulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "renderer/long/sums/accumulation_fixture.h"

namespace limpid::test {
namespace {

TEST(FixedPoint, IsTheNearestMultipleHalvesAwayFromZero) {
    EXPECT_EQ(toFixed(0.0, 4), 0);
    EXPECT_EQ(toFixed(-0.0, 4), 0);
    EXPECT_EQ(toFixed(1.0, 4), 16);
    EXPECT_EQ(toFixed(-1.5, 4), -24);
    EXPECT_EQ(toFixed(0.03, 4), 0);     // 0.48
    EXPECT_EQ(toFixed(0.03125, 4), 1);  // 0.5
    EXPECT_EQ(toFixed(-0.03125, 4), -1);
    EXPECT_EQ(toFixed(0.09, 4), 1);     // 1.44
    EXPECT_EQ(toFixed(0.09375, 4), 2);  // 1.5
    EXPECT_EQ(toFixed(std::numeric_limits<double>::denorm_min(), 62), 0);
    EXPECT_EQ(toFixed(0x1p64, 62), Int128{1} << 126);
    EXPECT_EQ(toFixed(-0x1p64, 62), -(Int128{1} << 126));
    EXPECT_EQ(toFixed(0x1p-62, 62), 1);
    EXPECT_EQ(toFixed(0x1p-63, 62), 1);
    EXPECT_EQ(toFixed(0x1.fffffp-64, 62), 0);
}

TEST(FixedPoint, AgreesWithLongDoubleOverItsRange) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> mantissa(-2.0, 2.0);
    for (int exponent = -70; exponent < 60; ++exponent) {
        for (int i = 0; i < 50; ++i) {
            const double value = std::ldexp(mantissa(random), exponent);
            // The 64-bit mantissa of long double represents a double times 2^62, rounded to an integer,
            // exactly.
            const long double expected = std::round(std::ldexp(static_cast<long double>(value), 62));
            EXPECT_EQ(static_cast<long double>(toFixed(value, 62)), expected) << value;
            EXPECT_EQ(fromFixed(toFixed(value, 62), 62), std::ldexp(expected, -62)) << value;
        }
    }
}

TEST(FrameSums, NeitherOrderNorGroupingChangesABit) {
    AccumulationHeader header = smallHeader();
    header.layers = allLayers;
    const FrameSums whole = randomSums(header, {0, 1, 2});
    std::vector<uint32_t> order{0, 1, 2};
    while (std::next_permutation(order.begin(), order.end())) expectSame(randomSums(header, order), whole);
    for (uint32_t alone = 0; alone < 3; ++alone) {
        FrameSums one = randomSums(header, {alone});
        const FrameSums others = randomSums(header, {(alone + 1) % 3, (alone + 2) % 3});
        FrameSums merged = others;
        merged.merge(one);
        expectSame(merged, whole);
        one.merge(others);
        expectSame(one, whole);
    }
}

TEST(FrameSums, MeansAndVariancesAreThoseOfAllSamples) {
    AccumulationHeader header = smallHeader();
    header.layers = allLayers;
    const FrameSums sums = randomSums(header, {0, 1, 2});
    ASSERT_EQ(sums.samples(), 40u);
    const RenderedLayers result = sums.means();
    for (const LayerSums& layer : sums.layers) {
        const std::vector<float>& got = result[*layer.info];
        for (size_t p = 0; p < 6; ++p) {
            double mean[4] = {}, square = 0.0;
            const auto of = [&](const auto* v) {
                if (layer.info->varianceOf == VarianceOf::FirstComponent) return double{v[0]} * v[0];
                if (layer.info->varianceOf == VarianceOf::MeanOfComponents)
                    return (double{v[0]} * v[0] + double{v[1]} * v[1] + double{v[2]} * v[2]) / 3.0;
                const double l = 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];
                return l * l;
            };
            for (uint32_t block = 0; block < 3; ++block) {
                const std::vector<float> m = randomMeans(*layer.info, block, 6);
                const double share = header.plan.samplesOf(block) / 40.0;
                for (size_t c = 0; c < 4; ++c) mean[c] += share * double{m[p * 4 + c]};
                square += share * (double{m[p * 4 + 3]} + of(&m[p * 4]));
            }
            for (size_t c = 0; c < layer.info->meanComponents(); ++c)
                EXPECT_FLOAT_EQ(got[p * 4 + c], static_cast<float>(mean[c])) << layer.info->name;
            if (!layer.squares) continue;
            EXPECT_NEAR(got[p * 4 + 3], square - of(mean), 1e-6) << layer.info->name;
        }
    }
    EXPECT_EQ(result.ids, std::vector<uint32_t>(12, 7));
    EXPECT_EQ(randomSums(header, {1}).means().ids, std::vector<uint32_t>(12, UINT32_MAX)) << "nothing";
}

TEST(FrameSums, OneBlocksMeansComeBackExactly) {
    AccumulationHeader header = smallHeader();
    header.plan.samples = 16;
    const FrameSums sums = randomSums(header, {0});
    const std::vector<float> expected = randomMeans(*sums.layers[0].info, 0, 6);
    const std::vector<float> got = sums.means().beauty;
    for (size_t p = 0; p < 6; ++p) {
        for (size_t c = 0; c < 4; ++c) EXPECT_EQ(got[p * 4 + c], expected[p * 4 + c]);
    }
}

TEST(FrameSums, WhatIsBeyondTheRangeIsClampedAndCounted) {
    AccumulationHeader header = smallHeader();
    FrameSums sums(header.extent, header.plan, header.layers);
    std::vector<float> means(24, 1.0f);
    means[0] = std::numeric_limits<float>::quiet_NaN();
    means[1] = std::numeric_limits<float>::infinity();
    means[2] = -1e30f;
    means[4] = 0x1p40f;  // the largest value
    for (uint32_t block = 0; block < 3; ++block) {
        sums.addBlock(block, [&](const LayerInfo&) { return means; });
    }
    EXPECT_EQ(sums.counts.clamped, 9u);
    const std::vector<float> got = sums.means().beauty;
    EXPECT_EQ(got[0], 0.0f);
    EXPECT_EQ(got[1], 0x1p40f);
    EXPECT_EQ(got[2], -0x1p40f);
    EXPECT_EQ(got[4], 0x1p40f);
    EXPECT_EQ(got[5], 1.0f);
}

TEST(FrameSums, TheMostSamplesOfTheLargestDoNotOverflow) {
    AccumulationHeader header = smallHeader();
    header.extent = {1, 1};
    header.plan = {.samples = maxSamplesPerPixel, .blockSamples = maxBlockSamples, .launchSamples = 1};
    header.layers = {"variance"};
    FrameSums sums(header.extent, header.plan, header.layers);
    const std::vector<float> largest{0x1p40f, 0x1p40f, 0x1p40f, std::numeric_limits<float>::max()};
    for (uint32_t block = 0; block < header.plan.blocks(); ++block)
        sums.addBlock(block, [&](const LayerInfo&) { return largest; });
    const RenderedLayers result = sums.means();
    EXPECT_EQ(result.diffuse[0], 0x1p40f);
    EXPECT_EQ(result.depth[0], 0x1p40f);
    EXPECT_TRUE(std::isfinite(result.depth[3]) && result.depth[3] >= 0.0f);
    EXPECT_GT(sums.counts.clamped, 0u);
}

TEST(FrameSums, WrongUseIsRefused) {
    const AccumulationHeader header = smallHeader();
    FrameSums sums = randomSums(header, {1});
    EXPECT_THROW(addRandomBlock(sums, 1), Error);
    EXPECT_THROW(sums.merge(randomSums(header, {0, 1})), Error);
    EXPECT_THROW(sums.addBlock(0, [](const LayerInfo&) { return std::vector<float>(4); }), Error);
    AccumulationHeader other = header;
    other.extent = {2, 3};
    EXPECT_THROW(sums.merge(randomSums(other, {0})), Error);
    EXPECT_THROW(FrameSums(header.extent, header.plan, header.layers).means(), Error);
    sums.addPart(3, [&](const LayerInfo& layer) { return randomMeans(layer, 0, 6); });
    EXPECT_EQ(sums.samples(), 19u);
    EXPECT_THROW(addRandomBlock(sums, 2), Error);
}

}  // namespace
}  // namespace limpid::test
