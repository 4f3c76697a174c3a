// Tests decoding in bounded memory: a picture that is scaled down has the means of whole cells, its size
// follows from the header, and there is a warning. tests/cli/cli_image_memory_test.cpp measures the whole
// program.
#include <gtest/gtest.h>
#include <stb/stb_image_write.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "image/color.h"
#include "image/io/environment_image.h"
#include "image/io/exr/exr.h"
#include "image/io/hdr.h"
#include "image/io/temp_folder.h"
#include "image/io/texture/texture_decode.h"
#include "image/srgb_bytes.h"

namespace limpid::image {
namespace {

using test::TempFolder;

ByteImage randomPicture(uint32_t width, uint32_t height, uint32_t components) {
    std::mt19937 random(7);
    ByteImage image{width, height, components, {}};
    image.pixels.resize(size_t{width} * height * components);
    for (uint8_t& v : image.pixels) v = static_cast<uint8_t>(random());
    return image;
}

/// Low frequencies only: JPEG's cosine transform does not scale with box weights.
ByteImage smoothPicture(uint32_t width, uint32_t height) {
    ByteImage image{width, height, 3, {}};
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
            const auto wave = [&](float f) {
                return static_cast<uint8_t>(128.0f + 100.0f * std::sin(f * static_cast<float>(x + 2 * y)));
            };
            image.pixels.insert(image.pixels.end(), {wave(0.01f), wave(0.02f), wave(0.03f)});
        }
    }
    return image;
}

std::vector<std::byte> pngOf(const ByteImage& image) {
    const std::vector<char> bytes = encodePng(image, "a.png");
    return test::toByteVector({bytes.begin(), bytes.end()});
}

/// Computes the mean of every cell in double, independently of the tested code.
ByteImage boxFiltered(const ByteImage& from, uint32_t n, bool srgb) {
    const uint32_t c = from.components;
    ByteImage to{std::max(1u, from.width / n), std::max(1u, from.height / n), c, {}};
    const auto end = [&](uint32_t cell, uint32_t cells, uint32_t size) {
        return cell + 1 == cells ? size : (cell + 1) * n;
    };
    for (uint32_t y = 0; y < to.height; ++y) {
        for (uint32_t x = 0; x < to.width; ++x) {
            for (uint32_t k = 0; k < c; ++k) {
                double sum = 0.0;
                int count = 0;
                for (uint32_t j = y * n; j < end(y, to.height, from.height); ++j) {
                    for (uint32_t i = x * n; i < end(x, to.width, from.width); ++i, ++count) {
                        const float v =
                            static_cast<float>(from.pixels[(size_t{j} * from.width + i) * c + k]) / 255;
                        sum += static_cast<double>(srgb && k < 3 ? srgbDecode(v) : v);
                    }
                }
                const auto mean = static_cast<float>(sum / count);
                to.pixels.push_back(
                    static_cast<uint8_t>((srgb && k < 3 ? srgbEncode(mean) : mean) * 255 + 0.5f));
            }
        }
    }
    return to;
}

struct Warned {
    ByteImage image;
    std::string messages;
};

Warned decodeWarned(const std::vector<std::byte>& bytes, const TextureDecoding& how) {
    testing::internal::CaptureStderr();
    Warned result;
    try {
        result.image = decodeTexture(bytes, "big.picture", how);
    } catch (const InputError& error) {
        ADD_FAILURE() << error.what();
    }
    result.messages = testing::internal::GetCapturedStderr();
    return result;
}

void expectNear(const ByteImage& image, const ByteImage& expected, int tolerance) {
    ASSERT_EQ(image.width, expected.width);
    ASSERT_EQ(image.height, expected.height);
    for (size_t i = 0; i < size_t{image.width} * image.height; ++i) {
        for (size_t c = 0; c < expected.components; ++c) {
            ASSERT_NEAR(image.pixels[i * 4 + c], expected.pixels[i * expected.components + c], tolerance)
                << "texel " << i << " component " << c;
        }
    }
}

TEST(SrgbBytes, EncodeAndDecodeAsTheFormulasDo) {
    const SrgbBytes table;
    for (int b = 0; b < 256; ++b) {
        EXPECT_EQ(table.encode(table.decode(static_cast<uint8_t>(b))), b);
    }
    std::mt19937 random(1);
    for (int i = 0; i < 100000; ++i) {
        const float x = std::uniform_real_distribution<float>(0.0f, i % 2 ? 1.0f : 0.01f)(random);
        const float exact = srgbEncode(x) * 255.0f;
        ASSERT_LE(std::abs(static_cast<float>(table.encode(x)) - exact), 0.5001f) << x;
    }
    EXPECT_EQ(table.encode(-1.0f), 0);
    EXPECT_EQ(table.encode(2.0f), 255);
    EXPECT_EQ(table.encode(std::nanf("")), 0);
}

TEST(BoundedTexture, APngBecomesTheMeansOfItsCells) {
    // 203x101 leaves incomplete cells at two edges.
    for (const bool srgb : {true, false}) {
        const ByteImage picture = randomPicture(203, 101, 4);
        const std::vector<std::byte> bytes = pngOf(picture);
        const TextureDecoding whole{.srgb = srgb};
        const Warned same = decodeWarned(bytes, whole);
        EXPECT_EQ(same.image.pixels, picture.pixels);
        EXPECT_EQ(same.messages, "");
        // For 203x101 texels, and a third more for mip levels.
        for (const auto& [texels, n] : {std::pair{7000u, 2u}, {1100u, 5u}}) {
            const Warned scaled = decodeWarned(bytes, {.srgb = srgb, .maxTexels = texels});
            expectNear(scaled.image, boxFiltered(picture, n, srgb), 1);
            EXPECT_NE(scaled.messages.find("big.picture: scaled down from 203x101 to " +
                                           std::to_string(203 / n) + "x" + std::to_string(101 / n)),
                      std::string::npos)
                << scaled.messages;
            EXPECT_NE(scaled.messages.find("--max-image-memory"), std::string::npos);
        }
    }
}

TEST(BoundedTexture, MemoryDecidesTheSize) {
    const std::vector<std::byte> bytes = pngOf(smoothPicture(512, 512));
    for (const uint64_t memory :
         {uint64_t{512} * 512 * 16, uint64_t{512} * 512 * 16 - 1, uint64_t{1} << 20, uint64_t{1} << 19}) {
        const Warned result = decodeWarned(bytes, {.maxMemory = memory});
        const uint64_t texels = uint64_t{result.image.width} * result.image.height;
        EXPECT_LE(texels * 16, memory);
        EXPECT_EQ(result.messages.empty(), texels == 512 * 512) << result.messages;
        const uint32_t n = 512 / result.image.width;
        if (memory > bytes.size() + (uint64_t{1} << 18) && n > 1) {
            EXPECT_GT(uint64_t{512 / (n - 1)} * (512 / (n - 1)) * 16, memory) << "scaled too far";
        }
    }
    // Not even the file and its rows fit into this memory.
    EXPECT_THROW(decodeTexture(bytes, "a.png", {.maxMemory = 1024}), InputError);
}

TEST(BoundedTexture, AJpegIsScaledInItsTransform) {
    const ByteImage picture = smoothPicture(512, 256);
    std::string text;
    const auto append = [](void* context, void* data, int size) {
        static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
    };
    stbi_write_jpg_to_func(append, &text, 512, 256, 3, picture.pixels.data(), 95);
    const std::vector<std::byte> bytes = test::toByteVector(text);
    for (const auto& [divisor, texels] : {std::pair{2u, 60000u}, {4u, 15000u}, {8u, 3000u}}) {
        const Warned scaled = decodeWarned(bytes, {.maxTexels = texels});
        expectNear(scaled.image, boxFiltered(picture, divisor, false), 6);
        EXPECT_NE(scaled.messages.find("from 512x256 to"), std::string::npos) << scaled.messages;
    }
    EXPECT_THROW(decodeTexture(bytes, "a.jpg", {.maxTexels = 2000}), InputError) << "only 8 times";
}

TEST(BoundedTexture, WhatCannotBeScaledIsRefused) {
    std::string tga(18, '\0');
    tga[2] = 3;
    tga[12] = tga[14] = 100;
    tga[16] = 8;
    tga += std::string(100 * 100, 'x');
    const std::vector<std::byte> bytes = test::toByteVector(tga);
    EXPECT_EQ(decodeTexture(bytes, "a.tga", {.tgaAndBmp = true}).pixels[0], 'x');
    EXPECT_THROW(decodeTexture(bytes, "a.tga", {.tgaAndBmp = true, .maxMemory = 100'000}), InputError);
    EXPECT_THROW(decodeTexture(bytes, "a.tga", {.tgaAndBmp = false}), InputError);
    for (size_t size = 0; size < 100; ++size)
        EXPECT_THROW(decodeTexture(std::span(bytes).first(size), "a.tga", {.tgaAndBmp = true}), InputError);
}

/// Returns a file of uncompressed random pixels.
std::string hdrOf(uint32_t width, uint32_t height, bool bottomUp) {
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + std::string(bottomUp ? "+Y " : "-Y ") +
                       std::to_string(height) + " +X " + std::to_string(width) + "\n";
    std::mt19937 random(3);
    for (size_t i = 0; i < size_t{width} * height; ++i) {
        for (int c = 0; c < 3; ++c) text += static_cast<char>(3 + random() % 250);
        text += static_cast<char>(126 + random() % 6);
    }
    return text;
}

void expectCells(const Image& scaled, const Image& whole, uint32_t n) {
    ASSERT_EQ(scaled.width, whole.width / n);
    ASSERT_EQ(scaled.height, whole.height / n);
    const auto end = [&](uint32_t cell, uint32_t cells, uint32_t size) {
        return cell + 1 == cells ? size : (cell + 1) * n;
    };
    for (uint32_t y = 0; y < scaled.height; ++y) {
        for (uint32_t x = 0; x < scaled.width; ++x) {
            double sum = 0.0;
            int count = 0;
            for (uint32_t j = y * n; j < end(y, scaled.height, whole.height); ++j) {
                for (uint32_t i = x * n; i < end(x, scaled.width, whole.width); ++i, ++count)
                    sum += static_cast<double>(whole.at(i, j, 1));
            }
            ASSERT_NEAR(scaled.at(x, y, 1), sum / count, 1e-5 * sum / count) << x << " " << y;
        }
    }
}

/// A bound that reduces 200x100 pixels to cells of 3x3: 2,178 pixels.
constexpr uint64_t memoryForThirds = 3000 * environmentBytesPerPixel;

TEST(BoundedEnvironment, AnHdrBecomesTheMeansOfItsCells) {
    TempFolder folder;
    for (const bool bottomUp : {false, true}) {
        const std::string text = hdrOf(200, 100, bottomUp);
        test::put(folder / "a.hdr", text);
        ASSERT_LT(text.size(), memoryForThirds / 2);
        const Image whole = readHdr(folder / "a.hdr");
        EXPECT_EQ(readEnvironmentImage(folder / "a.hdr").pixels, whole.pixels);
        testing::internal::CaptureStderr();
        const Image scaled = readEnvironmentImage(folder / "a.hdr", memoryForThirds);
        const std::string messages = testing::internal::GetCapturedStderr();
        EXPECT_NE(messages.find("a.hdr: scaled down from 200x100 to 66x33"), std::string::npos) << messages;
        if (!bottomUp) expectCells(scaled, whole, 3);
        EXPECT_EQ(scaled.width, 66u);
    }
    test::put(folder / "b.hdr", hdrOf(200, 99, true));
    expectCells(readEnvironmentImage(folder / "b.hdr", memoryForThirds), readHdr(folder / "b.hdr"), 3);
}

TEST(BoundedEnvironment, AnExrBecomesTheMeansOfItsCellsWithoutItsOtherChannels) {
    TempFolder folder;
    std::mt19937 random(9);
    Image color(200, 100, 3), other(200, 100, 3, 1.0f);
    for (float& v : color.pixels) v = std::uniform_real_distribution<float>(0.0f, 4.0f)(random);
    color.at(5, 5, 1) = std::nanf("");
    color.at(6, 5, 1) = -1.0f;
    for (const Compression compression : {Compression::None, Compression::Zip, Compression::Piz}) {
        LayeredImage layers;
        layers.add("", "RGB", color, Storage::Float);
        layers.add("albedo", "RGB", other, Storage::Half);
        writeExr(folder / "a.exr", layers, compression);
        const Image whole = readEnvironmentImage(folder / "a.exr");
        EXPECT_EQ(whole.at(7, 5, 1), color.at(7, 5, 1));
        EXPECT_EQ(whole.at(5, 5, 1), 0.0f) << "no NaN spoils a cell";
        const uint64_t room = std::filesystem::file_size(folder / "a.exr") + (uint64_t{1} << 20);
        const Image scaled = readEnvironmentImage(folder / "a.exr", room);
        expectCells(scaled, whole, 200 / scaled.width);
        EXPECT_LE(uint64_t{scaled.width} * scaled.height * environmentBytesPerPixel, room);
    }
}

TEST(BoundedEnvironment, AFileBeyondTheBoundIsRefusedUnread) {
    TempFolder folder;
    test::put(folder / "a.hdr", hdrOf(64, 64, false));
    EXPECT_THROW(readEnvironmentImage(folder / "a.hdr", 1000), InputError);
}

}  // namespace
}  // namespace limpid::image
