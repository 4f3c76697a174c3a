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
        for (uint32_t x = 40; x < 46; ++x)
            for (uint32_t c = 0; c < 3; ++c) picture.at(x, y, c) = y < 42 ? NAN : INFINITY;
    const std::vector<uint8_t> lamps = found(picture);
    EXPECT_EQ(std::count(lamps.begin(), lamps.end(), 1), 8 * 6 + 6 * 2);
    const std::vector<uint8_t> nothing = found(Image(4, 4, 3, NAN));
    EXPECT_EQ(std::count(nothing.begin(), nothing.end(), 1), 0);
}

/// An infinite spot at (40, 40).
void addSpot(Image& picture, uint32_t side) {
    for (uint32_t y = 40; y < 40 + side; ++y)
        for (uint32_t x = 40; x < 40 + side; ++x)
            for (uint32_t c = 0; c < 3; ++c) picture.at(x, y, c) = INFINITY;
}

/// Whether the spot, which may have another lamp beside it, is found.
bool isSpotFound(const Image& picture, const SurfaceGuides& guides, uint32_t side) {
    const std::vector<uint8_t> lamps =
        findEmitters(picture, std::vector<float>(size_t{size} * size, 1.0f), guides);
    const auto count = static_cast<uint32_t>(std::count(lamps.begin(), lamps.end(), 1));
    EXPECT_TRUE(count == 8 * 6 || count == 8 * 6 + side * side) << count;
    return count > 8 * 6;
}

/// As many as a pixel filter makes of one sample.
TEST(Emitters, AFewInfinitePixelsAreALampOnlyIfTheyAreASurfaceOfTheirOwn) {
    for (const uint32_t side : {2u, 3u, 4u, 5u}) {
        Image picture = pictureWithLamp(20.0f), albedo(size, size, 3), ids(size, size, 1, 7.0f);
        for (uint32_t y = 0; y < size; ++y)  // a texture
            for (uint32_t x = 0; x < size; ++x)
                for (uint32_t c = 0; c < 3; ++c) albedo.at(x, y, c) = (x / 2 + y / 3) % 2 == 0 ? 0.2f : 0.7f;
        addSpot(picture, side);
        EXPECT_EQ(isSpotFound(picture, {}, side), side > 4) << side;
        EXPECT_EQ(isSpotFound(picture, {&albedo, nullptr, &ids}, side), side > 4) << side;
        for (uint32_t c = 0; c < 3; ++c) albedo.at(40, 41, c) = 8.0f;
        EXPECT_TRUE(isSpotFound(picture, {.albedo = &albedo}, side)) << side;
        EXPECT_TRUE(isSpotFound(picture, {&albedo, nullptr, &ids}, side)) << side << ": nobody gave ids";
        ids.at(1, 1, 0) = 8.0f;
        EXPECT_EQ(isSpotFound(picture, {&albedo, nullptr, &ids}, side), side > 4) << side << ": no object";
        ids.at(41, 41, 0) = 8.0f;
        EXPECT_TRUE(isSpotFound(picture, {&albedo, nullptr, &ids}, side)) << side;
    }
}

TEST(Emitters, FinelyDetailedSurfacesAreNoLamps) {
    Image normal(size, size, 3), ids(size, size, 1, 7.0f);
    std::mt19937 random(11);
    std::normal_distribution<float> direction;
    for (size_t p = 0; p < size_t{size} * size; ++p) {
        const vec3 n = glm::normalize(vec3(direction(random), direction(random), direction(random)));
        for (int c = 0; c < 3; ++c) normal.pixels[3 * p + static_cast<size_t>(c)] = n[c];
    }
    ids.at(1, 1, 0) = 8.0f;
    for (const uint32_t side : {2u, 3u, 4u}) {
        Image picture = pictureWithLamp(20.0f);
        addSpot(picture, side);
        EXPECT_FALSE(isSpotFound(picture, {.normal = &normal}, side)) << side;
        EXPECT_FALSE(isSpotFound(picture, {.normal = &normal, .id = &ids}, side)) << side;
        ids.at(41, 41, 0) = 8.0f;
        EXPECT_TRUE(isSpotFound(picture, {.normal = &normal, .id = &ids}, side)) << side;
        ids.at(41, 41, 0) = 7.0f;
    }
}

TEST(Emitters, AFewInfinitePixelsOfALampBelongToIt) {
    Image picture = pictureWithLamp(60000.0f);
    for (uint32_t y = 12; y < 15; ++y)
        for (uint32_t x = 22; x < 25; ++x)
            for (uint32_t c = 0; c < 3; ++c) picture.at(x, y, c) = INFINITY;
    const std::vector<uint8_t> lamps = found(picture);
    EXPECT_EQ(lamps[13 * size + 23], 1);
    EXPECT_EQ(lamps[11 * size + 21], 1);
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
