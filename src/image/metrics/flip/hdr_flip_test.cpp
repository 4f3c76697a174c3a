#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "base/error.h"
#include "image/metrics/flip/flip_direct.h"
#include "image/metrics/metrics.h"
#include "image/tonemap.h"

namespace limpid::image {
namespace {

constexpr double ppd = flipPixelsPerDegree;

// A second implementation of HDR-FLIP, from the paper, on top of the double-precision FLIP of flip_direct.h.
namespace direct_hdr {

double aces(double radiance) {
    const double x = 0.6 * std::max(radiance, 0.0);
    return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

/// Finds the radiance that `aces` maps to 0.85, by bisection.
double radianceOfTarget() {
    double low = 0, high = 100;
    for (int i = 0; i < 200; ++i) (aces((low + high) / 2) < 0.85 ? low : high) = (low + high) / 2;
    return low;
}

std::vector<double> sortedLuminances(const Image& image) {
    std::vector<double> y;
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
        const float* p = &image.pixels[i];
        y.push_back(0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]);
    }
    std::sort(y.begin(), y.end());
    return y;
}

std::vector<double> exposures(const Image& reference) {
    const std::vector<double> y = sortedLuminances(reference);
    const double median = (y[(y.size() - 1) / 2] + y[y.size() / 2]) / 2;
    const double start = std::log2(radianceOfTarget() / y.back());
    const double stop = std::log2(radianceOfTarget() / median);
    const int count = std::max(2, static_cast<int>(std::ceil(stop - start)));
    std::vector<double> result;
    for (int i = 0; i < count; ++i) result.push_back(start + i * (stop - start) / (count - 1));
    return result;
}

direct::Picture toneMapped(const Image& image, double stops) {
    direct::Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
        const auto shown = [&](size_t c) { return aces(std::pow(2.0, stops) * image.pixels[i + c]); };
        picture.linear.push_back({shown(0), shown(1), shown(2)});
    }
    return picture;
}

std::vector<double> flip(const Image& test, const Image& reference) {
    std::vector<double> worst(size_t{test.width} * test.height, 0.0);
    for (const double stops : exposures(reference)) {
        const auto map = direct::flip(toneMapped(test, stops), toneMapped(reference, stops), ppd);
        for (size_t i = 0; i < worst.size(); ++i) worst[i] = std::max(worst[i], map[i]);
    }
    return worst;
}

}  // namespace direct_hdr

/// Radiance over 2^-6 .. 2^6: blocks of one colour beside noise.
Image hdrImage(uint32_t width, uint32_t height, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> stops(-6.0f, 6.0f);
    std::array<float, 3> block{};
    Image image(width, height, 3);
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
            if (x % 5 == 0)
                block = {std::exp2(stops(random)), std::exp2(stops(random)), std::exp2(stops(random))};
            for (uint32_t c = 0; c < 3; ++c)
                image.at(x, y, c) = x > width / 2 ? block[c] : std::exp2(stops(random));
        }
    }
    return image;
}

Image times(Image image, float factor) {
    for (float& v : image.pixels) v *= factor;
    return image;
}

/// One row of grey pixels.
Image greys(const std::vector<float>& values) {
    Image image(static_cast<uint32_t>(values.size()), 1, 3);
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = values[i / 3];
    return image;
}

TEST(HdrFlip, EqualImagesGiveExactlyZero) {
    const Image image = hdrImage(17, 12, 1);
    const HdrFlip result = hdrFlip(image, image);
    EXPECT_EQ(result.value, 0.0);
    for (const float v : result.map.pixels) ASSERT_EQ(v, 0.0f);
}

TEST(HdrFlip, AgreesWithTheFormulas) {
    for (const auto& [width, height] : {std::pair{30u, 21u}, {15u, 9u}, {1u, 1u}, {2u, 3u}}) {
        const Image reference = hdrImage(width, height, 1);
        Image similar = reference;
        std::mt19937 random(5);
        for (float& v : similar.pixels)
            v *= std::exp2(0.2f * (static_cast<float>(random() % 1000) / 500.0f - 1.0f));
        for (const Image& test : {hdrImage(width, height, 2), similar}) {
            const HdrFlip result = hdrFlip(test, reference);
            const std::vector<double> exposures = direct_hdr::exposures(reference);
            ASSERT_EQ(static_cast<size_t>(result.exposures.count), exposures.size());
            EXPECT_NEAR(result.exposures.start, exposures.front(), 1e-6);
            EXPECT_NEAR(result.exposures.stop, exposures.back(), 1e-6);
            const std::vector<double> want = direct_hdr::flip(test, reference);
            double sum = 0.0;
            for (size_t i = 0; i < want.size(); ++i) {
                ASSERT_NEAR(result.map.pixels[i], want[i], 2e-4) << i;
                sum += want[i];
            }
            EXPECT_NEAR(result.value, sum / static_cast<double>(want.size()), 1e-4);
        }
    }
}

TEST(HdrFlip, GreysByHand) {
    // Both pictures are uniform, so both exposures map the reference to 0.85, and FLIP is just the distance
    // of two lightnesses.
    const Image reference(40, 30, 3, 7.0f), test(40, 30, 3, 3.5f);
    const HdrFlip result = hdrFlip(test, reference);
    const double x = 0.6 * direct_hdr::radianceOfTarget() / 2.0;
    const double shown = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    const double lightness = 116.0 * (std::cbrt(0.85) - std::cbrt(shown));
    const double largest =
        std::pow(direct::hyab(direct::toHuntLab({0, 1, 0}), direct::toHuntLab({0, 0, 1})), 0.7);
    const double distance = std::pow(lightness, 0.7);
    ASSERT_LT(distance, 0.4 * largest);
    for (const float v : result.map.pixels) ASSERT_NEAR(v, 0.95 * distance / (0.4 * largest), 1e-4);
}

TEST(HdrFlip, ExposuresComeFromTheBrightestAndTheMedianPixel) {
    const double target = direct_hdr::radianceOfTarget();
    EXPECT_NEAR(filmicCurveInverse(0.85), target, 1e-6);
    // Luminances 1, 2, 4, 64: the median is 3. Six stops and a bit: the brightest is 64 / 3 as bright.
    const HdrFlipExposures four = hdrFlipExposures(greys({4, 64, 1, 2}));
    EXPECT_NEAR(four.start, std::log2(target / 64), 1e-6);
    EXPECT_NEAR(four.stop, std::log2(target / 3), 1e-6);
    EXPECT_EQ(four.count, 5);
    EXPECT_NEAR(hdrFlipExposures(greys({5, 1, 80})).stop, std::log2(target / 5), 1e-6);
    // With one pixel, or uniform brightness, there are the paper's minimum of two exposures, here equal.
    const HdrFlipExposures one = hdrFlipExposures(greys({8}));
    EXPECT_EQ(one.count, 2);
    EXPECT_EQ(one.start, one.stop);
}

TEST(HdrFlip, CountsExposuresAsThePublishedExampleDoes) {
    // NVIDIA's program reports 14 exposures from -12.5423 to 0.9427 for its example picture.
    const double target = direct_hdr::radianceOfTarget();
    const auto brightest = static_cast<float>(target * std::exp2(12.5423));
    const auto median = static_cast<float>(target * std::exp2(-0.9427));
    const HdrFlipExposures exposures = hdrFlipExposures(greys({0.0f, median, brightest}));
    EXPECT_NEAR(exposures.start, -12.5423, 1e-5);
    EXPECT_NEAR(exposures.stop, 0.9427, 1e-5);
    EXPECT_EQ(exposures.count, 14);
}

TEST(HdrFlip, ABlackReferenceAndABlackMedianHaveExposures) {
    const HdrFlipExposures black = hdrFlipExposures(greys({0, 0, 0}));
    EXPECT_EQ(black.start, 0.0);
    EXPECT_EQ(black.stop, 0.0);
    EXPECT_EQ(black.count, 2);
    EXPECT_GT(hdrFlip(greys({1, 1, 1}), greys({0, 0, 0})).value, 0.5);
    const double target = direct_hdr::radianceOfTarget();
    const HdrFlipExposures mostly = hdrFlipExposures(greys({0, 0, 0, 0, 0, 2, 4, 16}));
    EXPECT_NEAR(mostly.stop, std::log2(target / 4), 1e-6) << "the median of the pixels that are not black";
    EXPECT_NEAR(hdrFlipExposures(greys({-5, 3, 3})).stop, std::log2(target / 3), 1e-6) << "negative is 0";
}

TEST(HdrFlip, ScalingBothImagesChangesNothing) {
    const Image test = hdrImage(25, 17, 3), reference = hdrImage(25, 17, 4);
    const HdrFlip result = hdrFlip(test, reference);
    for (const float factor : {16.0f, 1.0f / 1024.0f, 3.7f}) {
        const HdrFlip scaled = hdrFlip(times(test, factor), times(reference, factor));
        EXPECT_EQ(scaled.exposures.count, result.exposures.count);
        EXPECT_NEAR(scaled.exposures.start + std::log2(factor), result.exposures.start, 1e-5);
        for (size_t i = 0; i < result.map.pixels.size(); ++i)
            ASSERT_NEAR(scaled.map.pixels[i], result.map.pixels[i], 2e-4) << factor;
    }
}

TEST(HdrFlip, SeesWhatOneExposureClips) {
    Image reference(40, 20, 3, 0.2f), test = reference;
    for (uint32_t y = 5; y < 15; ++y) {
        for (uint32_t x = 10; x < 30; ++x) {
            for (uint32_t c = 0; c < 3; ++c) reference.at(x, y, c) = 100.0f, test.at(x, y, c) = 30.0f;
        }
    }
    EXPECT_EQ(compare(test, reference, 0.0f).flip, 0.0) << "both are clipped to white";
    EXPECT_GT(hdrFlip(test, reference).map.at(20, 10, 0), 0.3f);
}

TEST(HdrFlip, InvalidPixelsCountAsTheWorst) {
    const Image reference(20, 20, 3, 0.25f);
    Image test = reference;
    test.at(4, 5, 1) = std::nanf("");
    test.at(6, 7, 0) = std::numeric_limits<float>::infinity();
    const HdrFlip result = hdrFlip(test, reference);
    EXPECT_EQ(result.map.at(4, 5, 0), 1.0f);
    EXPECT_EQ(result.map.at(6, 7, 0), 1.0f);
    for (const float v : result.map.pixels) ASSERT_TRUE(v >= 0.0f && v <= 1.0f);
    EXPECT_EQ(result.map.at(19, 19, 0), 0.0f) << "far from both";
    EXPECT_THROW(hdrFlip(reference, test), Error) << "the reference must be valid";
    EXPECT_THROW(hdrFlip(Image(2, 2, 3), Image(3, 2, 3)), Error);
}

TEST(HdrFlip, ExtremeRadianceStaysFinite) {
    const float most = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();
    const HdrFlip result = hdrFlip(greys({least, most, 1, 0}), greys({most, least, least, 0}));
    for (const float v : result.map.pixels) ASSERT_TRUE(v >= 0.0f && v <= 1.0f) << v;
    EXPECT_GT(result.value, 0.1);
}

}  // namespace
}  // namespace limpid::image
