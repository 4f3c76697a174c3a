#include "image/colormap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "image/io/png/png.h"
#include "image/io/temp_folder.h"

namespace limpid::image {
namespace {

TEST(Magma, MeetsTheTableAtAFewPlaces) {
    // Entries 0, 64, 128, 191 and 255 of matplotlib's table.
    const std::pair<int, std::array<float, 3>> table[] = {{0, {0.001462f, 0.000466f, 0.013866f}},
                                                          {64, {0.316654f, 0.07169f, 0.48538f}},
                                                          {128, {0.716387f, 0.214982f, 0.47529f}},
                                                          {191, {0.986700f, 0.535582f, 0.38221f}},
                                                          {255, {0.987053f, 0.991438f, 0.749504f}}};
    for (const auto& [index, want] : table) {
        const auto color = magma(static_cast<float>(index) / 255.0f);
        for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(color[c], want[c], 0.02f) << index << " " << c;
    }
    EXPECT_EQ(magma(-1.0f), magma(0.0f));
    EXPECT_EQ(magma(2.0f), magma(1.0f));
    EXPECT_EQ(magma(std::nanf("")), magma(1.0f)) << "what is no number is no small error";
}

TEST(Magma, GetsLighter) {
    float previous = -1.0f;
    for (int i = 0; i <= 255; ++i) {
        const auto c = magma(static_cast<float>(i) / 255.0f);
        const float luma = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
        ASSERT_GT(luma, previous - 1e-3f) << i;
        previous = luma;
    }
}

TEST(ErrorMap, IsAPngOfTheColours) {
    test::TempFolder folder;
    Image errors(2, 1, 1);
    errors.pixels = {0.0f, 1.0f};
    writeErrorMap(folder / "e.png", errors);
    const ByteImage image = readPngOrJpeg(folder / "e.png");
    EXPECT_LT(image.pixels[0], 5);
    EXPECT_GT(image.pixels[4], 245);
    EXPECT_THROW(magma(Image(1, 1, 3)), Error);
}

}  // namespace
}  // namespace limpid::image
