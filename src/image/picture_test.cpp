#include "image/picture.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "image/color.h"
#include "image/exr.h"
#include "image/png.h"
#include "image/temp_folder.h"

namespace limpid::image {
namespace {

TEST(Picture, ContentDecidesAndPngBecomesLinear) {
    test::TempFolder folder;
    writePng(folder / "a.exr", ByteImage{1, 1, 4, {0, 128, 255, 7}});
    const Picture png = readPicture(folder / "a.exr");
    EXPECT_FALSE(png.sceneReferred);
    EXPECT_EQ(png.linear.pixels, (std::vector<float>{0.0f, srgbDecode(128.0f / 255.0f), 1.0f}));

    LayeredImage layers;
    layers.add("ViewLayer.Combined", "RGBA", Image(1, 1, 4, 5.0f), Storage::Half);
    writeExr(folder / "b.png", layers);
    const Picture exr = readPicture(folder / "b.png");
    EXPECT_TRUE(exr.sceneReferred);
    EXPECT_EQ(exr.linear.pixels, (std::vector<float>(3, 5.0f)));

    test::put(folder / "c", "#?RADIANCE\n\n-Y 1 +X 1\n\x80\x80\x80\x84");
    EXPECT_EQ(readPicture(folder / "c").linear.pixels, (std::vector<float>(3, 8.0f)));
}

TEST(Picture, RefusesWhatIsNoColourPicture) {
    test::TempFolder folder;
    LayeredImage layers;
    layers.add("depth", "Z", Image(1, 1, 1), Storage::Float);
    writeExr(folder / "a.exr", layers);
    test::put(folder / "text", "hello");
    EXPECT_THROW(readPicture(folder / "a.exr"), InputError);
    EXPECT_THROW(readPicture(folder / "text"), InputError);
    EXPECT_THROW(readPicture(folder / "none"), InputError);
}

}  // namespace
}  // namespace limpid::image
