#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "image/metrics/flip/flip_direct.h"
#include "image/metrics/metrics.h"

namespace limpid::image {
namespace {

Image constant(uint32_t width, uint32_t height, float r, float g, float b) {
    Image image(width, height, 3);
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
        image.pixels[i] = r;
        image.pixels[i + 1] = g;
        image.pixels[i + 2] = b;
    }
    return image;
}

/// Noise over a few flat rectangles: all frequencies, and colours at the gamut's border.
Image busyImage(uint32_t width, uint32_t height, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    Image image(width, height, 3);
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
            for (uint32_t c = 0; c < 3; ++c) {
                const bool inside = (x / 9 + y / 7 + c + seed) % 3 == 0;
                image.at(x, y, c) = x > width / 2 ? (inside ? 1.0f : 0.0f) : uniform(random);
            }
        }
    }
    return image;
}

TEST(Flip, GreenAgainstBlueIsExactlyOne) {
    const Image green = constant(40, 25, 0, 1, 0), blue = constant(40, 25, 0, 0, 1);
    for (const Image& map : {flip(green, blue), flip(blue, green)}) {
        for (const float v : map.pixels) ASSERT_EQ(v, 1.0f);
    }
}

TEST(Flip, EqualImagesGiveExactlyZero) {
    const Image image = busyImage(30, 20, 1);
    for (const float v : flip(image, image).pixels) ASSERT_EQ(v, 0.0f);
}

TEST(Flip, AgreesWithTheFormulas) {
    const Image a = busyImage(48, 37, 1);
    Image similar = a;
    std::mt19937 random(9);
    for (float& v : similar.pixels)
        v = std::clamp(v + 0.1f * (static_cast<float>(random() % 1000) / 1000.0f - 0.5f), 0.0f, 1.0f);
    for (const Image& b : {busyImage(48, 37, 2), similar}) {
        for (const double ppd : {flipPixelsPerDegree, 30.0}) {
            const Image map = flip(a, b, ppd);
            const std::vector<double> want = direct::flip(a, b, ppd);
            for (size_t i = 0; i < want.size(); ++i) ASSERT_NEAR(map.pixels[i], want[i], 1e-4) << i;
        }
    }
}

/// Pictures are compared tile by tile. Cut out of a larger picture, the same pixels lie elsewhere in the
/// tiles.
TEST(Flip, HasNoSeams) {
    constexpr uint32_t left = 37, top = 45, reach = 12, size = 150;
    const auto part = [](const Image& whole) {
        Image image(size, size, 3);
        for (uint32_t y = 0; y < size; ++y) {
            for (uint32_t x = 0; x < size; ++x) {
                for (uint32_t c = 0; c < 3; ++c) image.at(x, y, c) = whole.at(x + left, y + top, c);
            }
        }
        return image;
    };
    const Image a = busyImage(220, 210, 1), b = busyImage(220, 210, 2);
    const Image map = flip(a, b), ofPart = flip(part(a), part(b));
    for (uint32_t y = reach; y < size - reach; ++y) {
        for (uint32_t x = reach; x < size - reach; ++x)
            ASSERT_EQ(ofPart.at(x, y, 0), map.at(x + left, y + top, 0)) << x << ' ' << y;
    }
}

TEST(Flip, WorksOnImagesSmallerThanItsFilters) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {2u, 9u}, {25u, 1u}}) {
        const Image a = busyImage(width, height, 3), b = busyImage(width, height, 4);
        const std::vector<double> want = direct::flip(a, b, flipPixelsPerDegree);
        const Image map = flip(a, b);
        for (size_t i = 0; i < want.size(); ++i) ASSERT_NEAR(map.pixels[i], want[i], 1e-4);
    }
}

TEST(Flip, IsSymmetricAndBounded) {
    const Image a = busyImage(31, 22, 5), b = busyImage(31, 22, 6);
    const Image ab = flip(a, b), ba = flip(b, a);
    for (size_t i = 0; i < ab.pixels.size(); ++i) {
        ASSERT_EQ(ab.pixels[i], ba.pixels[i]);
        ASSERT_TRUE(ab.pixels[i] >= 0.0f && ab.pixels[i] <= 1.0f);
    }
}

}  // namespace
}  // namespace limpid::image
