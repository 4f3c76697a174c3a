#include "image/io/pfm.h"

#include <gmock/gmock.h>

#include <bit>
#include <string>

#include "base/error.h"
#include "image/io/picture.h"
#include "image/io/temp_folder.h"

namespace limpid::image {
namespace {

std::string words(std::initializer_list<float> values, bool bigEndian) {
    std::string bytes;
    for (const float value : values) {
        const auto word = std::bit_cast<uint32_t>(value);
        for (unsigned i = 0; i < 4; ++i)
            bytes += static_cast<char>(word >> (8 * (bigEndian ? 3 - i : i)) & 255u);
    }
    return bytes;
}

TEST(Pfm, RowsGoUpwardsInEitherByteOrder) {
    for (const bool bigEndian : {false, true}) {
        const std::string text = std::string("Pf\n2 2\n") + (bigEndian ? "1.0" : "-1.0") + "\n" +
                                 words({3, 4, 1, -0.5f}, bigEndian);
        const Image image = decodePfm(test::toByteVector(text), "a.pfm");
        EXPECT_EQ(image.components, 1u);
        EXPECT_THAT(image.pixels, testing::ElementsAre(1, -0.5f, 3, 4));
    }
}

TEST(Pfm, IsReadAsAPicture) {
    const test::TempFolder folder;
    test::put(folder / "a.pfm", "PF 1 1 -1\n" + words({1, 200, 3}, false));
    test::put(folder / "b.pfm", "Pf\r\n1 1\r\n-1\r\n" + words({7}, false));
    EXPECT_THAT(readPicture(folder / "a.pfm").linear.pixels, testing::ElementsAre(1, 200, 3));
    EXPECT_TRUE(readPicture(folder / "a.pfm").sceneReferred);
    EXPECT_THAT(readPicture(folder / "b.pfm").linear.pixels, testing::ElementsAre(7, 7, 7));
}

TEST(Pfm, DamagedFilesAreRefused) {
    const std::string good = "PF\n1 1\n-1\n" + words({1, 2, 3}, false);
    for (size_t size = 0; size < good.size(); ++size)
        EXPECT_THROW(decodePfm(test::toByteVector(good.substr(0, size)), "a.pfm"), InputError) << size;
    for (const char* text :
         {"PF\n0 1\n-1\n", "PF\n99999999 99999999\n-1\n", "PF\n-1 1\n-1\n", "PF\n1 x\n-1\n", "P6\n1 1\n"})
        EXPECT_THROW(decodePfm(test::toByteVector(text + words({1, 2, 3}, false)), "a.pfm"), InputError)
            << text;
}

}  // namespace
}  // namespace limpid::image
