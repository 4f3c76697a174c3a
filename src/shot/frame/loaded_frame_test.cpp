#include "shot/frame/loaded_frame.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "image/io/exr/exr.h"
#include "image/io/png/png.h"
#include "image/io/temp_folder.h"

namespace limpid::shot {
namespace {

using image::test::TempFolder;

TEST(LoadedFrame, ContentDecidesTheFormatAndNotTheName) {
    const TempFolder folder;
    for (const char* name : {"a.PNG", "b.exr", "c"}) {
        image::writePng(folder / name, {2, 1, 4, {255, 0, 0, 255, 0, 0, 255, 255}});
        LoadedFrame frame = loadFrame(folder / name, 0, {});
        EXPECT_EQ(frame.file.width(), 2u) << name;
        EXPECT_EQ(frame.file.values(0, "R"), (std::vector<float>{1, 0})) << name;
        EXPECT_EQ(frame.content, contentOf(folder / name, 0, {})) << name;
    }
    image::LayeredImage layers;
    layers.add("", "RGB", image::Image(1, 1, 3, 5.0f), image::Storage::Half);
    image::writeExr(folder / "d.png", layers);
    EXPECT_EQ(loadFrame(folder / "d.png", 0, {}).file.values(0, "G"), std::vector<float>{5});
}

TEST(LoadedFrame, UnknownContentIsRefused) {
    const TempFolder folder;
    image::test::put(folder / "a.png", "nothing known");
    EXPECT_THROW(loadFrame(folder / "a.png", 0, {}), InputError);
}

}  // namespace
}  // namespace limpid::shot
