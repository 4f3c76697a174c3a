#include "image/io/hdr.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/error.h"
#include "image/io/environment_image.h"
#include "image/io/exr/exr.h"
#include "image/io/temp_folder.h"

namespace limpid::image {
namespace {

using test::TempFolder;

std::string header(const std::string& resolution, const std::string& extra = "") {
    return "#?RADIANCE\n# a comment\n" + extra + "FORMAT=32-bit_rle_rgbe\n\n" + resolution + "\n";
}

Image decode(const std::string& text) {
    return decodeHdr(test::toByteVector(text), "test.hdr");
}

/// 10x2: red runs, green literals, blue 0, exponent 129 (scale 2^-7).
std::string newRunsText() {
    std::string row = std::string("\x02\x02\x00\x0a", 4);
    row += "\x8a\x40";                      // ten times 64
    row += "\x04\x01\x02\x03\x04\x86\x80";  // four literals, then six times 128
    row += std::string("\x8a\x00", 2);      // ten times 0
    row += "\x8a\x81";                      // exponent
    return header("-Y 2 +X 10") + row + row;
}

void expectNewRuns(const Image& image) {
    ASSERT_EQ(image.width, 10u);
    ASSERT_EQ(image.height, 2u);
    ASSERT_EQ(image.components, 3u);
    for (uint32_t y = 0; y < 2; ++y) {
        for (uint32_t x = 0; x < 10; ++x) {
            EXPECT_EQ(image.at(x, y, 0), 0.5f);
            EXPECT_EQ(image.at(x, y, 1), (x < 4 ? static_cast<float>(x + 1) : 128.0f) / 128.0f);
            EXPECT_EQ(image.at(x, y, 2), 0.0f);
        }
    }
}

TEST(Hdr, ReadsPerComponentRuns) {
    expectNewRuns(decode(newRunsText()));
}

TEST(Hdr, ReadsFlatPixelsAndOldRuns) {
    // One pixel, repeated 3 times, another, then 0x102 times in two run pixels: 1 + 3 + 1 + 258 = 263.
    const std::string pixels =
        std::string("\x80\x40\x20\x81\x01\x01\x01\x03\x10\x10\x10\x80\x01\x01\x01\x02\x01\x01\x01\x01", 20);
    const Image image = decode(header("-Y 1 +X 263") + pixels);
    EXPECT_EQ(image.at(0, 0, 0), 1.0f);
    EXPECT_EQ(image.at(3, 0, 1), 0.5f);
    EXPECT_EQ(image.at(4, 0, 0), 16.0f / 256.0f);
    EXPECT_EQ(image.at(262, 0, 2), 16.0f / 256.0f);
}

TEST(Hdr, AZeroExponentIsBlackAndRowsMayRunUpwards) {
    const std::string pixels = std::string("\x80\x80\x80\x00\x80\x80\x80\x82", 8);
    EXPECT_EQ(decode(header("-Y 2 +X 1") + pixels).pixels, (std::vector<float>{0, 0, 0, 2, 2, 2}));
    EXPECT_EQ(decode(header("+Y 2 +X 1") + pixels).pixels, (std::vector<float>{2, 2, 2, 0, 0, 0}));
}

TEST(Hdr, DividesTheExposuresOut) {
    const std::string pixel = "\x80\x80\x80\x81";
    EXPECT_EQ(decode(header("-Y 1 +X 1", "EXPOSURE=2.0\nEXPOSURE= 4\n") + pixel).pixels[0], 0.125f);
    EXPECT_THROW(decode(header("-Y 1 +X 1", "EXPOSURE=0\n") + pixel), InputError);
    EXPECT_THROW(decode(header("-Y 1 +X 1", "EXPOSURE=x\n") + pixel), InputError);
    EXPECT_THROW(decode(header("-Y 1 +X 1", "EXPOSURE=nan\n") + pixel), InputError);
}

TEST(Hdr, EveryTruncationIsAnInputErrorAndFlippedBitsNeverCrash) {
    const std::string whole = newRunsText();
    for (size_t size = 0; size < whole.size(); ++size) {
        EXPECT_THROW(decode(whole.substr(0, size)), InputError) << size;
    }
    std::mt19937 random(1);
    for (int i = 0; i < 3000; ++i) {
        std::string text = whole;
        for (int flips = 0; flips <= i % 3; ++flips) {
            text[random() % text.size()] ^= static_cast<char>(1u << (random() % 8));
        }
        try {
            decode(text);
        } catch (const InputError&) {
        }
    }
}

TEST(Hdr, RefusesWhatItCannotRead) {
    const std::string pixel = "\x80\x80\x80\x81";
    for (const std::string resolution : {"-Y 60000 +X 60000", "-Y 0 +X 1", "-Y 1 +X 0", "+X 1 -Y 1",
                                         "-Y 1 -X 1", "-Y 99999999999 +X 1", "-Y -1 +X 1", "", "x"}) {
        EXPECT_THROW(decode(header(resolution) + pixel), InputError) << resolution;
    }
    EXPECT_THROW(decode("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + pixel), InputError);
    EXPECT_THROW(decode("\n\n-Y 1 +X 1\n" + pixel), InputError);
    EXPECT_THROW(decode(header("-Y 1 +X 2") + std::string("\x01\x01\x01\x01", 4)), InputError)
        << "repeats nothing";
    EXPECT_THROW(decode(header("-Y 1 +X 2") + pixel + "\x01\x01\x01\x02"), InputError)
        << "runs over the row's end";
    EXPECT_THROW(decode(std::string(100000, 'x')), InputError) << "a line without end";
}

TEST(Hdr, AWrongMagicNumberIsNamed) {
    try {
        decode("\x89PNG\r\n\x1a\n");
        FAIL() << "was accepted";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("it begins with 89 50 4e 47, as a PNG picture does"),
                  std::string::npos)
            << error.what();
    }
}

TEST(EnvironmentImage, ReadsEitherFormatAndCleansIt) {
    TempFolder folder;
    test::put(folder / "a.HDR", newRunsText());
    expectNewRuns(readEnvironmentImage(folder / "a.HDR"));

    Image image(2, 1, 3);
    image.pixels = {1.0f, -1.0f, std::nanf(""), std::numeric_limits<float>::infinity(), 2.0f, 3.0f};
    LayeredImage layers;
    layers.add("sky", "RGB", image, Storage::Float);
    writeExr(folder / "a.exr", layers);
    EXPECT_EQ(readEnvironmentImage(folder / "a.exr").pixels, (std::vector<float>{1, 0, 0, 0, 2, 3}));

    LayeredImage grey, nothing;
    grey.add("", "Y", Image(1, 1, 1, 0.5f), Storage::Half);
    writeExr(folder / "grey.exr", grey);
    EXPECT_EQ(readEnvironmentImage(folder / "grey.exr").pixels, (std::vector<float>(3, 0.5f)));
    nothing.add("depth", "Z", Image(1, 1, 1), Storage::Half);
    writeExr(folder / "nothing.exr", nothing);
    EXPECT_THROW(readEnvironmentImage(folder / "nothing.exr"), InputError);
    EXPECT_THROW(readEnvironmentImage(folder / "a.png"), InputError);
    EXPECT_THROW(readEnvironmentImage(folder / "none.hdr"), InputError);
}

}  // namespace
}  // namespace limpid::image
