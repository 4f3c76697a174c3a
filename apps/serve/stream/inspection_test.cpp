#include "serve/stream/inspection.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace limpid::serve {
namespace {

using nlohmann::json;

/// Every pixel of a 64x32 picture has moved by (x, y) pixels.
image::Image motion(float x, float y, float valid = 1.0f) {
    image::Image image(64, 32, 4);
    for (size_t at = 0; at < image.pixels.size(); at += 4) {
        image.pixels[at] = -x;
        image.pixels[at + 1] = -y;
        image.pixels[at + 3] = valid;
    }
    return image;
}

TEST(Inspection, MakesAPictureOnceForEachImageAndView) {
    auto image = std::make_shared<image::Image>(3, 2, 1);
    image->pixels = {0.0f, 1.0f, 0.5f, 0.25f, 2.0f, -1.0f};
    InspectedPicture inspected;
    studio::InspectorView view;
    const auto first = inspected.of(image, view);
    EXPECT_EQ(first->extent, (gpu::Extent{3, 2}));
    EXPECT_EQ(first->texels, studio::shownTexels(*image, view));
    EXPECT_EQ(inspected.of(image, view), first);
    view.stops = -1.0f;
    const auto darker = inspected.of(image, view);
    EXPECT_NE(darker->texels, first->texels);
    EXPECT_EQ(darker->texels, studio::shownTexels(*image, view));
    const auto other = std::make_shared<image::Image>(1, 1, 1);
    EXPECT_EQ(inspected.of(other, view)->extent, (gpu::Extent{1, 1}));
}

TEST(Inspection, TellsTheValuesOfAPixel) {
    image::Image image(4, 2, 2);
    const float infinite = std::numeric_limits<float>::infinity();
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i) / 2.0f;
    image.pixels[14] = std::numeric_limits<float>::quiet_NaN();
    image.pixels[15] = -infinite;
    EXPECT_EQ(valuesAt(&image, {0.3f, 0.4f}), (json{{"pixel", {1, 0}}, {"values", {1.0, 1.5}}}));
    EXPECT_EQ(valuesAt(&image, {1.0f, 1.0f}), (json{{"pixel", {3, 1}}, {"values", {"nan", "-inf"}}}));
    EXPECT_EQ(valuesAt(nullptr, {0.5f, 0.5f}), json::object());
    const image::Image none;
    EXPECT_EQ(valuesAt(&none, {0.5f, 0.5f}), json::object());
}

TEST(Inspection, TheMotionGridGoesBackToWhereThingsWere) {
    const MotionGrid grid = motionGrid(motion(3.2f, -1.6f), {128, 64});
    EXPECT_EQ(grid.columns, 4);
    EXPECT_EQ(grid.rows, 2);
    ASSERT_EQ(grid.offsets.size(), 8u);
    EXPECT_FLOAT_EQ(grid.offsets[0].x, -0.05f);
    EXPECT_FLOAT_EQ(grid.offsets[0].y, 0.05f);
    // Only the right half moves.
    image::Image half = motion(0.0f, 0.0f);
    for (uint32_t y = 0; y < 32; ++y) {
        for (uint32_t x = 32; x < 64; ++x) half.pixels[4 * (size_t{y} * 64 + x)] = 8.0f;
    }
    const MotionGrid parts = motionGrid(half, {128, 64});
    EXPECT_EQ(parts.offsets[1], vec2(0.0f));
    EXPECT_EQ(parts.offsets[2], vec2(0.125f, 0.0f));
}

TEST(Inspection, RestAndWhatIsNotValidDoNotMove) {
    for (const image::Image& image : {motion(0.1f, 0.1f), motion(5.0f, 0.0f, 0.0f),
                                      motion(std::numeric_limits<float>::quiet_NaN(), 1.0f)}) {
        const MotionGrid grid = motionGrid(image, {128, 64});
        ASSERT_EQ(grid.offsets.size(), 8u);
        for (const vec2& offset : grid.offsets) EXPECT_EQ(offset, vec2(0.0f));
    }
    EXPECT_TRUE(motionGrid({}, {128, 64}).offsets.empty());
    EXPECT_EQ(motionGrid({}, {128, 64}).columns, 0);
    EXPECT_EQ(motionGrid(motion(1.0f, 0.0f), {3, 3}).columns, 1);
}

TEST(Inspection, PacksFloats) {
    const auto bytes = packed(MotionGrid{1, 2, {vec2(0.5f, -1.0f), vec2(0.0f, 2.0f)}});
    ASSERT_EQ(bytes.size(), 16u);
    const std::array<float, 4> expected{0.5f, -1.0f, 0.0f, 2.0f};  // this machine is little endian
    EXPECT_EQ(std::memcmp(bytes.data(), expected.data(), 16), 0);
}

}  // namespace
}  // namespace limpid::serve
