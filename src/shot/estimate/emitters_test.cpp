#include "shot/estimate/emitters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "shot/frame/shot_frame.h"

namespace limpid::shot {
namespace {

using image::Image;

constexpr uint32_t size = 64;

/// A wall lit with so few samples that half of the pixels get no light, and a lamp of 8 x 6 pixels whose last
/// column is covered by half.
Image pictureWithLamp(float lamp) {
    Image picture(size, size, 3);
    std::mt19937 random(7);
    std::exponential_distribution<float> light(1.0f);
    for (size_t p = 0; p < size * size; ++p) {
        const float value = random() % 2 == 0 ? 0.0f : light(random);
        for (size_t c = 0; c < 3; ++c)
            picture.pixels[3 * p + c] = value * (1.0f - 0.2f * static_cast<float>(c));
    }
    for (uint32_t y = 10; y < 16; ++y)
        for (uint32_t x = 20; x < 28; ++x)
            for (uint32_t c = 0; c < 3; ++c)
                picture.at(x, y, c) = (x == 27 ? 0.5f : 1.0f) * lamp * (1.0f - 0.1f * static_cast<float>(c));
    return picture;
}

std::vector<uint8_t> found(const Image& picture) {
    return findEmitters(picture, std::vector<float>(picture.pixels.size() / 3, 1.0f));
}

TEST(Emitters, ALampIsFoundWithItsEdgeAndNoiseIsNot) {
    const std::vector<uint8_t> lamps = found(pictureWithLamp(20.0f));
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x)
            EXPECT_EQ(lamps[y * size + x] != 0, x >= 20 && x < 28 && y >= 10 && y < 16) << x << ", " << y;
}

TEST(Emitters, AnEvenWallInTheDarkIsNoLamp) {
    const std::vector<uint8_t> lamps = found(pictureWithLamp(0.5f));
    EXPECT_EQ(std::count(lamps.begin(), lamps.end(), 1), 0);
    const std::vector<uint8_t> flat = found(Image(size, size, 3, 1.0f));
    EXPECT_EQ(std::count(flat.begin(), flat.end(), 1), 0);
}

TEST(Emitters, ASingleBrightPixelIsNoLamp) {
    Image picture = pictureWithLamp(0.5f);
    for (uint32_t c = 0; c < 3; ++c) picture.at(40, 40, c) = 1000.0f;
    const std::vector<uint8_t> lamps = found(picture);
    EXPECT_EQ(lamps[40 * size + 40], 0);
}

TEST(Emitters, InfiniteLampsAreFoundAndNanIsNone) {
    Image picture = pictureWithLamp(20.0f);
    for (uint32_t y = 40; y < 44; ++y)
        for (uint32_t x = 40; x < 44; ++x)
            for (uint32_t c = 0; c < 3; ++c) picture.at(x, y, c) = y < 42 ? NAN : INFINITY;
    const std::vector<uint8_t> lamps = found(picture);
    EXPECT_EQ(std::count(lamps.begin(), lamps.end(), 1), 8 * 6 + 4 * 2);
    const std::vector<uint8_t> nothing = found(Image(4, 4, 3, NAN));
    EXPECT_EQ(std::count(nothing.begin(), nothing.end(), 1), 0);
}

TEST(Emitters, ABrightSkyIsNoLamp) {
    const Image picture = pictureWithLamp(20.0f);
    std::vector<float> distance(size * size, 1.0f);
    for (uint32_t y = 10; y < 16; ++y)
        for (uint32_t x = 20; x < 27; ++x) distance[y * size + x] = 0.0f;
    const std::vector<uint8_t> lamps = findEmitters(picture, distance);
    EXPECT_EQ(std::count(lamps.begin(), lamps.end(), 1), 0) << "neither the sky nor what stands before it";
}

TEST(Emitters, WithoutALayerOfEmissionALampIsNotFiltered) {
    ShotLayers layers;
    layers.width = layers.height = size;
    layers.images["beauty"] = pictureWithLamp(20.0f);
    const size_t lamp = 12 * size + 22, wall = 40 * size + 22;
    denoise::HostFrame frame = FrameConverter(LayerMap{}).convert(layers, {}, false);
    EXPECT_EQ(frame.emission[4 * lamp], 20.0f);
    EXPECT_EQ(frame.diffuse[4 * lamp], 0.0f);
    EXPECT_EQ(frame.depth[4 * lamp + 1], 0.0f);
    EXPECT_EQ(frame.emission[4 * wall], 0.0f);
    EXPECT_EQ(frame.diffuse[4 * wall], layers.images["beauty"].pixels[3 * wall]);

    layers.images["emission"] = Image(size, size, 3);  // that says otherwise
    frame = FrameConverter(LayerMap{}).convert(layers, {}, false);
    EXPECT_EQ(frame.emission[4 * lamp], 0.0f);
    EXPECT_EQ(frame.diffuse[4 * lamp], 20.0f);
}

}  // namespace
}  // namespace limpid::shot
