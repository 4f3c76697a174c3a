#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfHeader.h>
#include <ImfPartType.h>
#include <ImfTileDescription.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "base/error.h"
#include "image/io/exr/exr.h"
#include "image/io/temp_folder.h"

namespace limpid::image {
namespace {

using test::TempFolder;
using Bytes = std::vector<std::byte>;

Bytes validFile(Compression compression, uint32_t width = 40, uint32_t height = 36) {
    TempFolder folder;
    std::mt19937 random(3);
    Image color(width, height, 3), id(width, height, 1);
    for (float& v : color.pixels) v = static_cast<float>(random() % 1000) * 0.01f;
    for (float& v : id.pixels) v = static_cast<float>(random() % 50);
    LayeredImage image;
    image.add("", "RGB", color, Storage::Half);
    image.add("id", "I", id, Storage::Uint);
    image.metadata["limpid.samples"] = "16";
    writeExr(folder / "a.exr", image, compression);
    return test::toByteVector(test::get(folder / "a.exr"));
}

/// Returns the peak memory of this process in bytes.
size_t peakMemory() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<size_t>(usage.ru_maxrss) * 1024;
}

/// Overwrites the value of the attribute `name` (its bytes follow name, type and size).
void patch(Bytes& bytes, const std::string& name, const std::string& type, size_t offset,
           const std::vector<int32_t>& values) {
    const std::string key = name + '\0' + type + '\0';
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const size_t at = text.find(key);
    ASSERT_NE(at, std::string::npos) << name;
    std::memcpy(bytes.data() + (at + key.size() + 4 + offset), values.data(), 4 * values.size());
}

TEST(ExrMalformed, EveryTruncationIsAnInputError) {
    for (const Compression compression : {Compression::None, Compression::Zip, Compression::Piz}) {
        const Bytes whole = validFile(compression);
        ASSERT_NO_THROW(decodeExr(whole, "whole.exr"));
        for (size_t size = 0; size < whole.size(); size += size < 600 ? 1 : 37) {
            EXPECT_THROW(decodeExr(std::span(whole).first(size), "cut.exr"), InputError) << size;
        }
        EXPECT_THROW(decodeExr(std::span(whole).first(whole.size() - 1), "cut.exr"), InputError);
    }
}

TEST(ExrMalformed, FlippedBitsNeverCrash) {
    std::mt19937 random(11);
    size_t refused = 0;
    for (const Compression compression :
         {Compression::None, Compression::Rle, Compression::Zip, Compression::Piz}) {
        const Bytes whole = validFile(compression);
        for (int i = 0; i < 1500; ++i) {
            Bytes bytes = whole;
            // The header controls allocations, so most bit flips go there.
            const size_t range = i % 3 == 0 ? bytes.size() : std::min<size_t>(bytes.size(), 600);
            for (int flips = 0; flips <= i % 3; ++flips)
                bytes[random() % range] ^= std::byte(1u << (random() % 8));
            try {
                decodeExr(bytes, "flipped.exr");
            } catch (const InputError&) {
                ++refused;
            }
        }
    }
    EXPECT_GT(refused, 1000u);
}

TEST(ExrMalformed, AbsurdSizesAreRefusedWithoutAllocatingThem) {
    const size_t before = peakMemory();
    constexpr int32_t huge = 2147483647;
    const std::vector<std::vector<int32_t>> windows = {
        {0, 0, 59999, 59999},
        {0, 0, huge, huge},
        {-huge, -huge, huge, huge},
        {0, 0, huge, 0},
        {0, 0, 0, huge},
        {0, 0, 16383, 16383},
        {5, 5, 4, 4},
        {huge - 1, 0, huge, 1},
        {0, 0, 1 << 27, 0},
        {0, 0, 0, (1 << 27)},
        {-(1 << 27), 0, 1 << 27, 0},
        {100, 100, 0, 0},
    };
    for (const Compression compression : {Compression::None, Compression::Zip, Compression::Piz}) {
        for (const auto& window : windows) {
            for (const bool both : {false, true}) {
                Bytes bytes = validFile(compression, 4, 4);
                patch(bytes, "dataWindow", "box2i", 0, window);
                if (both) patch(bytes, "displayWindow", "box2i", 0, window);
                EXPECT_THROW(decodeExr(bytes, "absurd.exr"), InputError) << window[2] << "x" << window[3];
            }
        }
    }
    EXPECT_LT(peakMemory() - before, size_t{200} << 20);
}

TEST(ExrMalformed, AnAbsurdFrameAroundASmallPictureIsRefused) {
    Bytes bytes = validFile(Compression::Zip, 4, 4);
    patch(bytes, "displayWindow", "box2i", 0, {0, 0, 16383, 16383});
    EXPECT_THROW(decodeExr(bytes, "frame.exr"), InputError);
    bytes = validFile(Compression::Zip, 4, 4);
    patch(bytes, "displayWindow", "box2i", 0, {0, 0, 1919, 1079});
    EXPECT_EQ(decodeExr(bytes, "frame.exr").width, 1920u) << "a small crop of a normal frame is fine";
}

TEST(ExrMalformed, AbsurdAttributeSizesAreRefusedWithoutAllocatingThem) {
    const size_t before = peakMemory();
    for (const int32_t size : {2147483647, -1, 1 << 30}) {
        Bytes bytes = validFile(Compression::Zip, 4, 4);
        patch(bytes, "limpid.samples", "string", static_cast<size_t>(-4), {size});
        EXPECT_THROW(decodeExr(bytes, "attribute.exr"), InputError);
    }
    EXPECT_LT(peakMemory() - before, size_t{200} << 20);
}

TEST(ExrMalformed, ADeepFileIsRefusedByName) {
    TempFolder folder;
    Imf::Header header(4, 4);
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    { Imf::DeepScanLineOutputFile file((folder / "a.exr").c_str(), header); }
    try {
        readExr(folder / "a.exr");
        FAIL() << "it was read";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("deep"), std::string::npos) << error.what();
    }
}

TEST(ExrMalformed, OtherFilesAreNotExr) {
    TempFolder folder;
    for (const std::string& text :
         {std::string(), std::string("\x89PNG"), std::string(300, 'v'), std::string(300, '\0')}) {
        test::put(folder / "a.exr", text);
        EXPECT_THROW(readExr(folder / "a.exr"), InputError);
    }
    EXPECT_THROW(readExr(folder / "none.exr"), InputError);
    try {
        readExr(folder / "a.exr");
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("a.exr"), std::string::npos) << "the message names the file";
        EXPECT_NE(std::string(error.what()).find("it begins with 00 00 00 00"), std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace limpid::image
