#include "image/io/picture.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "image/color.h"
#include "image/io/exr/exr.h"
#include "image/io/png/png.h"
#include "image/io/temp_folder.h"

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

TEST(Picture, OfASequenceBringsItsGeometry) {
    test::TempFolder folder;
    LayeredImage layers;
    layers.add("", "RGB", Image(2, 1, 3, 0.5f), Storage::Half);
    Image motion(2, 1, 3);
    motion.pixels = {1, 2, 3, 4, 5, 6};
    layers.add("motion", "XYZ", motion, Storage::Float);
    layers.add("depth", "Z", Image(2, 1, 1, 7.0f), Storage::Float);
    layers.add("normal", "XY", Image(2, 1, 2), Storage::Half);
    writeExr(folder / "a.exr", layers);
    const SequencePicture picture = readSequencePicture(folder / "a.exr");
    EXPECT_EQ(picture.picture.linear.pixels, std::vector<float>(6, 0.5f));
    EXPECT_EQ(picture.geometry.motion->pixels, (std::vector<float>{1, 2, 4, 5}));
    EXPECT_EQ(picture.geometry.distanceChange->pixels, (std::vector<float>{3, 6}));
    EXPECT_EQ(picture.geometry.depth->pixels, (std::vector<float>{7, 7}));
    EXPECT_FALSE(picture.geometry.normal) << "a normal has three components";
    writePng(folder / "b.png", ByteImage{1, 1, 4, {0, 128, 255, 7}});
    EXPECT_FALSE(readSequencePicture(folder / "b.png").geometry.motion);
}

}  // namespace
}  // namespace limpid::image
