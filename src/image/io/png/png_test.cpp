#include "image/io/png/png.h"

#include <gtest/gtest.h>
#include <stb/stb_image_write.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "image/io/temp_folder.h"
#include "image/io/texture/texture_decode.h"

namespace limpid::image {
namespace {

using test::TempFolder;

ByteImage randomImage(uint32_t width, uint32_t height, uint32_t components) {
    std::mt19937 random(5);
    ByteImage image{width, height, components, {}};
    image.pixels.resize(size_t{width} * height * components);
    for (uint8_t& v : image.pixels) v = static_cast<uint8_t>(random());
    return image;
}

std::string jpegText() {
    const ByteImage image = randomImage(33, 17, 3);
    std::string text;
    const auto append = [](void* context, void* data, int size) {
        static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
    };
    stbi_write_jpg_to_func(append, &text, 33, 17, 3, image.pixels.data(), 90);
    return text;
}

/// Returns a PNG chunk with its correct checksum (computed bit by bit, unlike the tested code).
std::string chunk(const std::string& type, const std::string& data) {
    const auto word = [](uint32_t v) {
        return std::string{static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8),
                           static_cast<char>(v)};
    };
    uint32_t crc = 0xFFFFFFFFu;
    for (const char c : type + data) {
        crc ^= static_cast<uint8_t>(c);
        for (int k = 0; k < 8; ++k) crc = (crc & 1) ? 0xEDB88320u ^ (crc >> 1) : crc >> 1;
    }
    return word(static_cast<uint32_t>(data.size())) + type + data + word(~crc);
}

const std::string signature = "\x89PNG\r\n\x1a\n";

std::string ihdr(uint32_t width, uint32_t height, char depth, char color) {
    std::string data;
    for (const uint32_t v : {width, height}) {
        for (int shift = 24; shift >= 0; shift -= 8) data += static_cast<char>(v >> shift);
    }
    return chunk("IHDR", data + depth + color + std::string(3, '\0'));
}

/// Returns a zlib stream with one stored block.
std::string stored(const std::string& data) {
    const auto size = static_cast<uint16_t>(data.size());
    uint32_t a = 1, b = 0;
    for (const char c : data) {
        a = (a + static_cast<uint8_t>(c)) % 65521;
        b = (b + a) % 65521;
    }
    std::string text = "\x78\x01\x01";
    for (const uint16_t v : {size, static_cast<uint16_t>(~size)}) {
        text += static_cast<char>(v & 255);
        text += static_cast<char>(v >> 8);
    }
    text += data;
    for (const uint32_t v : {b >> 8, b & 255, a >> 8, a & 255}) text += static_cast<char>(v);
    return text;
}

TEST(Png, RoundTrip) {
    TempFolder folder;
    for (const uint32_t components : {3u, 4u}) {
        const ByteImage image = randomImage(31, 19, components);
        writePng(folder / "a.png", image);
        const ByteImage back = readPngOrJpeg(folder / "a.png");
        ASSERT_EQ(back.width, 31u);
        ASSERT_EQ(back.height, 19u);
        ASSERT_EQ(back.components, 4u);
        for (size_t i = 0; i < 31u * 19u; ++i) {
            for (size_t c = 0; c < components; ++c) {
                ASSERT_EQ(back.pixels[i * 4 + c], image.pixels[i * components + c]);
            }
            if (components == 3) {
                ASSERT_EQ(back.pixels[i * 4 + 3], 255);
            }
        }
    }
}

TEST(Png, SixteenBitsKeepThemAsFloatAndLoseThemAsBytes) {
    const std::string row = std::string("\0", 1) + "\x12\x34\xff\xff";
    const auto bytes =
        test::toByteVector(signature + ihdr(2, 1, 16, 0) + chunk("IDAT", stored(row)) + chunk("IEND", ""));
    const Image image = decodeImageFloat(bytes, "grey16.png");
    EXPECT_FLOAT_EQ(image.at(0, 0, 0), 0x1234 / 65535.0f);
    EXPECT_FLOAT_EQ(image.at(0, 0, 2), 0x1234 / 65535.0f);
    EXPECT_EQ(image.at(1, 0, 1), 1.0f);
    EXPECT_EQ(image.at(0, 0, 3), 1.0f);
    EXPECT_EQ(decodeImage(bytes, "grey16.png").pixels[0], 0x12);
}

TEST(Png, ToBytesRoundsClampsAndCoversNan) {
    Image image(2, 1, 3);
    image.pixels = {-1.0f, 0.5f, 2.0f, std::nanf(""), 1.0f / 255.0f, 1.0f};
    EXPECT_EQ(toBytes(image).pixels, (std::vector<uint8_t>{0, 128, 255, 0, 1, 255}));
    EXPECT_EQ(toBytes(Image(1, 1, 1, 1.0f)).pixels, (std::vector<uint8_t>{255, 255, 255}));
    EXPECT_THROW(toBytes(Image(1, 1, 2)), Error);
}

TEST(Png, AFailingWriteKeepsTheOldFile) {
    TempFolder folder;
    const auto path = folder / "a.png";
    test::put(path, "old");
    EXPECT_THROW(writePng(path, ByteImage{2, 2, 4, std::vector<uint8_t>(3)}), OutputError);
    EXPECT_THROW(writePng(folder / "none" / "a.png", randomImage(2, 2, 3)), OutputError);
    EXPECT_EXIT(
        {
            test::limitFileSize(1000);
            try {
                writePng(path, randomImage(64, 64, 3));
            } catch (const OutputError&) {
                std::_Exit(0);
            }
            std::_Exit(1);
        },
        testing::ExitedWithCode(0), "");
    EXPECT_EQ(test::get(path), "old");
    EXPECT_EQ(folder.files(), 1u);
}

TEST(Png, EveryTruncationAndEveryFlippedBitIsAnInputError) {
    TempFolder folder;
    writePng(folder / "a.png", randomImage(9, 7, 3));
    const auto whole = test::toByteVector(test::get(folder / "a.png"));
    for (size_t size = 0; size < whole.size(); ++size) {
        EXPECT_THROW(decodeImage(std::span(whole).first(size), "cut.png"), InputError) << size;
    }
    for (size_t bit = 0; bit < whole.size() * 8; bit += 3) {
        auto bytes = whole;
        bytes[bit / 8] ^= std::byte(1u << (bit % 8));
        EXPECT_THROW(decodeImage(bytes, "flipped.png"), InputError) << bit;
    }
}

TEST(Png, DamageUnderARightChecksumNeverCrashes) {
    std::mt19937 random(2);
    const std::string row = std::string("\0", 1) + "abcdefabcdef";
    const std::string data = stored(row + row + row);
    for (int i = 0; i < 3000; ++i) {
        std::string broken = data;
        for (int flips = 0; flips <= i % 4; ++flips) {
            broken[random() % broken.size()] ^= static_cast<char>(1u << (random() % 8));
        }
        const char color = "\0\2\3\4\6"[random() % 5];
        const char depth = "\1\2\4\10\20"[random() % 5];
        const std::string text =
            signature + ihdr(4, 3, depth, color) + chunk("IDAT", broken) + chunk("IEND", "");
        try {
            decodeImageFloat(test::toByteVector(text), "broken.png");
        } catch (const InputError&) {
        }
    }
}

TEST(Png, AbsurdSizesAreRefused) {
    for (const auto& [width, height] :
         {std::pair{60000u, 60000u}, {1u << 24, 1u}, {1u, 1u << 24}, {0u, 5u}, {0xFFFFFFFFu, 0xFFFFFFFFu}}) {
        const std::string text =
            signature + ihdr(width, height, 8, 2) + chunk("IDAT", stored("x")) + chunk("IEND", "");
        EXPECT_THROW(decodeImage(test::toByteVector(text), "absurd.png"), InputError)
            << width << "x" << height;
    }
}

TEST(Png, MessagesNameTheFault) {
    const auto faultOf = [](const std::string& text) -> std::string {
        try {
            decodeImage(test::toByteVector(text), "a.png");
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    };
    const std::string large =
        signature + ihdr(30000, 30000, 8, 2) + chunk("IDAT", std::string(400000, 'x')) + chunk("IEND", "");
    EXPECT_NE(faultOf(large).find("30000x30000"), std::string::npos) << faultOf(large);
    EXPECT_NE(faultOf(large).find("at most 268435456 pixels"), std::string::npos) << faultOf(large);
    EXPECT_NE(faultOf("GIF89a").find("begins with 47 49 46 38"), std::string::npos) << faultOf("GIF89a");
}

TEST(Png, TexturesMayHaveMorePixelsThanWholePictures) {
    const auto faultOf = [](uint32_t side) -> std::string {
        const std::string text =
            signature + ihdr(side, side, 8, 2) + chunk("IDAT", std::string(400000, 'x')) + chunk("IEND", "");
        try {
            // Too little memory for any size, so that nothing is decoded.
            decodeTexture(test::toByteVector(text), "a.png", {.maxMemory = 1024});
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_NE(faultOf(40000).find("at most 1073741824 pixels"), std::string::npos) << faultOf(40000);
    EXPECT_EQ(faultOf(30000).find("at most"), std::string::npos) << faultOf(30000);
    EXPECT_NE(faultOf(30000).find("30000x30000"), std::string::npos) << faultOf(30000);
}

TEST(Jpeg, DecodesAndRefusesEveryTruncation) {
    const auto whole = test::toByteVector(jpegText());
    const ByteImage image = decodeImage(whole, "a.jpg");
    EXPECT_EQ(image.width, 33u);
    EXPECT_EQ(image.height, 17u);
    EXPECT_EQ(image.pixels[3], 255);
    for (size_t size = 0; size < whole.size(); ++size) {
        EXPECT_THROW(decodeImage(std::span(whole).first(size), "cut.jpg"), InputError) << size;
    }
}

TEST(Jpeg, FlippedBitsNeverCrash) {
    std::mt19937 random(4);
    const auto whole = test::toByteVector(jpegText());
    for (int i = 0; i < 2000; ++i) {
        auto bytes = whole;
        for (int flips = 0; flips <= i % 3; ++flips) {
            const size_t range = i % 2 ? bytes.size() : std::min<size_t>(bytes.size(), 700);
            bytes[random() % range] ^= std::byte(1u << (random() % 8));
        }
        try {
            decodeImage(bytes, "flipped.jpg");
        } catch (const InputError&) {
        }
    }
}

TEST(Png, OtherFormatsAreRefused) {
    for (const std::string& text :
         {std::string(), std::string("GIF89a"), std::string("P6 1 1 255 abc"), std::string(64, 'x')}) {
        EXPECT_THROW(decodeImage(test::toByteVector(text), "other"), InputError);
    }
}

}  // namespace
}  // namespace limpid::image
