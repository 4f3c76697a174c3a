#include "image/metrics/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"
#include "image/color.h"

namespace limpid::image {
namespace {

Image randomImage(uint32_t width, uint32_t height, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    Image image(width, height, 3);
    for (float& v : image.pixels) v = uniform(random);
    return image;
}

/// Computes SSIM directly from its definition, in double precision: for each pixel a 2D window, the means,
/// then the variances about these means.
double directSsim(const Image& a, const Image& b) {
    const auto luma = [](const Image& image, int x, int y) {
        const auto column = static_cast<uint32_t>(std::clamp(x, 0, static_cast<int>(image.width) - 1));
        const auto row = static_cast<uint32_t>(std::clamp(y, 0, static_cast<int>(image.height) - 1));
        return 0.2126 * image.at(column, row, 0) + 0.7152 * image.at(column, row, 1) +
               0.0722 * image.at(column, row, 2);
    };
    double norm = 0.0;
    const auto weight = [](int i, int j) { return std::exp(-(i * i + j * j) / (2.0 * 1.5 * 1.5)); };
    for (int j = -5; j <= 5; ++j) {
        for (int i = -5; i <= 5; ++i) norm += weight(i, j);
    }
    const auto inside = [](int v, uint32_t length) {
        return length < 11 || (v >= 5 && v + 5 < static_cast<int>(length));
    };
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < static_cast<int>(a.height); ++y) {
        for (int x = 0; x < static_cast<int>(a.width); ++x) {
            if (!inside(x, a.width) || !inside(y, a.height)) continue;
            double ma = 0, mb = 0, va = 0, vb = 0, cov = 0;
            const auto forWindow = [&](const auto& f) {
                for (int j = -5; j <= 5; ++j) {
                    for (int i = -5; i <= 5; ++i)
                        f(weight(i, j) / norm, luma(a, x + i, y + j), luma(b, x + i, y + j));
                }
            };
            forWindow([&](double w, double p, double q) { ma += w * p, mb += w * q; });
            forWindow([&](double w, double p, double q) {
                va += w * (p - ma) * (p - ma), vb += w * (q - mb) * (q - mb), cov += w * (p - ma) * (q - mb);
            });
            sum += (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
            ++count;
        }
    }
    return sum / count;
}

TEST(Psnr, OfAConstantOffset) {
    Image a(16, 9, 3, 0.25f), b(16, 9, 3, 0.375f);
    EXPECT_NEAR(psnr(a, b), -20.0 * std::log10(0.125), 1e-9);
    EXPECT_EQ(psnr(a, a), std::numeric_limits<double>::infinity());
    EXPECT_NEAR(psnr(Image(3, 3, 3, 0.0f), Image(3, 3, 3, 1.0f)), 0.0, 1e-12);
}

TEST(RelMse, ByHand) {
    Image test(1, 2, 3), reference(1, 2, 3);
    test.pixels = {1, 2, 3, 0, 0, 10};
    reference.pixels = {1, 1, 1, 0, 1, 0};
    const double want = (0 + 1 / 1.01 + 4 / 1.01 + 0 + 1 / 1.01 + 100 / 0.01) / 6;
    EXPECT_NEAR(relMse(test, reference), want, 1e-9);
}

TEST(Ssim, IsOneForEqualAndAgreesWithTheDefinition) {
    for (const auto& [width, height] : {std::pair{40u, 23u}, {11u, 11u}, {30u, 7u}, {1u, 1u}, {3u, 50u}}) {
        const Image a = randomImage(width, height, 1);
        EXPECT_NEAR(ssim(a, a), 1.0, 1e-6);
        Image b = randomImage(width, height, 2);
        for (size_t i = 0; i < b.pixels.size(); ++i) b.pixels[i] = 0.7f * a.pixels[i] + 0.3f * b.pixels[i];
        EXPECT_NEAR(ssim(a, b), directSsim(a, b), 1e-5) << width << "x" << height;
        EXPECT_EQ(ssim(a, b), ssim(a, b)) << "the same on every run";
    }
    const Image black(20, 20, 3, 0.0f), white(20, 20, 3, 1.0f);
    EXPECT_NEAR(ssim(black, white), 1e-4 / 1.0001, 1e-7);
}

TEST(DisplayEncode, ExposesClampsAndEncodes) {
    Image image(2, 1, 3);
    image.pixels = {0.25f, 4.0f, -1.0f, std::nanf(""), std::numeric_limits<float>::infinity(), 0.0f};
    const Image encoded = displayEncode(image, 1.0f);
    EXPECT_FLOAT_EQ(encoded.pixels[0], srgbEncode(0.5f));
    EXPECT_EQ(std::vector<float>(encoded.pixels.begin() + 1, encoded.pixels.end()),
              (std::vector<float>{1, 0, 0, 1, 0}));
}

TEST(Compare, EqualImages) {
    const Image image = randomImage(33, 21, 3);
    const Comparison c = compare(image, image, -1.0f);
    EXPECT_EQ(c.psnr, std::numeric_limits<double>::infinity());
    EXPECT_NEAR(c.ssim, 1.0, 1e-6);
    EXPECT_EQ(c.relMse, 0.0);
    EXPECT_EQ(c.flip, 0.0);
    EXPECT_EQ(c.exposure, -1.0f);
    EXPECT_EQ(c.invalidPixels, 0u);
}

TEST(Compare, InvalidPixelsCountAsTheWorst) {
    Image reference(20, 20, 3, 0.25f), test = reference;
    test.at(4, 5, 1) = std::nanf("");
    test.at(6, 7, 0) = -std::numeric_limits<float>::infinity();
    const Comparison c = compare(test, reference, 0.0f);
    EXPECT_EQ(c.invalidPixels, 2u);
    EXPECT_EQ(c.flipMap.at(4, 5, 0), 1.0f);
    EXPECT_EQ(c.flipMap.at(6, 7, 0), 1.0f);
    const double shown = srgbEncode(0.25f);  // above 0.5, so black is farther than white
    EXPECT_NEAR(c.psnr, -10.0 * std::log10(2.0 / 400.0 * shown * shown), 1e-4);
    EXPECT_NEAR(c.relMse, 2.0 / 400.0 * std::pow(65504.0 - 0.25, 2) / 0.0725, 1e3);
    EXPECT_TRUE(std::isfinite(c.ssim) && std::isfinite(c.flip));
    EXPECT_LT(c.ssim, 1.0);
    EXPECT_THROW(compare(reference, test, 0.0f), Error) << "the reference must be valid";
}

TEST(Compare, RefusesWhatCannotBeCompared) {
    EXPECT_THROW(compare(Image(2, 2, 3), Image(2, 3, 3), 0.0f), Error);
    EXPECT_THROW(compare(Image(2, 2, 4), Image(2, 2, 4), 0.0f), Error);
    EXPECT_THROW(compare(Image(), Image(), 0.0f), Error);
    EXPECT_THROW(flip(Image(2, 2, 3), Image(3, 2, 3)), Error);
}

}  // namespace
}  // namespace limpid::image
