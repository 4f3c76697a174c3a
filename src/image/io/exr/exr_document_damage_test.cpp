// Damaged files: they are refused, or read and written whole; nothing else escapes, and memory stays bounded.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <random>

#include "base/error.h"
#include "image/io/exr/exr_files.h"
#include "image/io/temp_folder.h"

namespace limpid::image {
namespace {

using namespace test;

/// Counts what became of damaged files.
struct Outcomes {
    size_t refused = 0, read = 0, unwritable = 0, written = 0;

    /// Reads all channels, replaces one, and writes. Throws nothing.
    void add(const std::string& bytes, const std::filesystem::path& output) {
        ExrDocument document;
        try {
            document = ExrDocument::decode(test::toByteVector(bytes), "damaged.exr");
        } catch (const InputError&) {
            ++refused;
            return;
        } catch (const std::exception& error) {
            ADD_FAILURE() << "decode() threw " << error.what();
            return;
        }
        std::vector<size_t> intact;
        for (size_t i = 0; i < document.parts().size(); ++i) {
            if (readAll(document, i)) intact.push_back(i);
        }
        intact.empty() ? ++refused : ++read;
        if (!intact.empty()) change(document, intact[(refused + read) % intact.size()], output);
    }

  private:
    static bool readAll(ExrDocument& document, size_t part) {
        try {
            for (const ExrPart::Channel& channel : document.parts()[part].channels)
                document.values(part, channel.name);
            return !document.parts()[part].channels.empty();
        } catch (const InputError&) {
        } catch (const std::exception& error) {
            ADD_FAILURE() << "values() threw " << error.what();
        }
        return false;
    }

    void change(ExrDocument& document, size_t part, const std::filesystem::path& output) {
        const std::string channel = document.parts()[part].channels[0].name;
        try {
            const std::vector<float> values(size_t{document.width()} * document.height(), 2.0f);
            document.replace(part, channel, values);
            const std::vector<float> replaced = document.values(part, channel);
            document.write(output);
            ++written;
            EXPECT_EQ(ExrDocument::read(output).values(part, channel), replaced);
            EXPECT_EQ(Imf::MultiPartInputFile(output.c_str()).parts(),
                      static_cast<int>(document.parts().size()));
        } catch (const InputError&) {
            ++unwritable;
        } catch (const std::exception& error) {
            ADD_FAILURE() << "replace() or write() threw " << error.what();
        }
    }
};

/// Small files of several kinds, to be damaged.
class ExrDocumentDamaged : public testing::Test {
  protected:
    static Imf::Header small(const std::string& name, const std::string& type, Imf::Compression compression) {
        Imf::Header header(20, 18);
        header.compression() = compression;
        header.setName(name);
        header.setType(type);
        header.channels().insert("R", Imf::Channel(Imf::HALF));
        header.channels().insert("id", Imf::Channel(Imf::UINT));
        header.insert("comment", Imf::StringAttribute("any"));
        if (Imf::isTiled(type)) header.setTileDescription(Imf::TileDescription(16, 8));
        return header;
    }
    std::string single(const Imf::Header& header) {
        writeSingle(path(), header);
        return test::get(path());
    }
    std::string scanLines() { return single(small("a", Imf::SCANLINEIMAGE, Imf::ZIP_COMPRESSION)); }
    std::string tiles() { return single(small("a", Imf::TILEDIMAGE, Imf::PIZ_COMPRESSION)); }
    std::string parts() {
        std::vector<Imf::Header> headers = {small("rows", Imf::SCANLINEIMAGE, Imf::ZIP_COMPRESSION),
                                            small("tiles", Imf::TILEDIMAGE, Imf::RLE_COMPRESSION),
                                            small("deep", Imf::DEEPSCANLINE, Imf::ZIPS_COMPRESSION),
                                            small("deep tiles", Imf::DEEPTILE, Imf::NO_COMPRESSION),
                                            small("luma", Imf::SCANLINEIMAGE, Imf::NO_COMPRESSION)};
        headers[4].channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
        writeParts(path(), headers);
        return test::get(path());
    }
    std::filesystem::path path() const { return folder_ / "a.exr"; }

    TempFolder folder_;
};

TEST_F(ExrDocumentDamaged, FilesAreRefusedOrReadAndWrittenWhole) {
    std::mt19937 random(17);
    Outcomes outcomes;
    for (const std::string& whole : {scanLines(), tiles(), parts()}) {
        const size_t header = std::min<size_t>(whole.size(), 500);
        for (size_t i = 0; i < 25; ++i) outcomes.add(whole.substr(0, whole.size() * i / 25), path());
        outcomes.add(whole.substr(0, whole.size() - 1), path());
        for (size_t i = 0; i < 50; ++i) {
            std::string bytes = whole;
            const size_t at = random() % (i % 2 == 0 ? header : whole.size());
            bytes[at] = static_cast<char>(static_cast<uint32_t>(bytes[at]) + 1 + random() % 255);
            SCOPED_TRACE(testing::Message() << "byte " << at << " of " << whole.size());
            outcomes.add(bytes, path());
        }
    }
    EXPECT_EQ(outcomes.refused + outcomes.read, 3 * (25 + 1 + 50u));
    EXPECT_GT(outcomes.refused, 50u);
    EXPECT_GT(outcomes.unwritable, 5u);
    EXPECT_GT(outcomes.written, 50u);
}

/// Returns the peak memory of this process in bytes.
size_t peakOfProcess() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<size_t>(usage.ru_maxrss) * 1024;
}

TEST_F(ExrDocumentDamaged, BlocksOfAbsurdSizesAreNotCopied) {
    const std::string whole = parts();
    struct Case {
        std::array<int32_t, 5> begin;  ///< of a block: part, then row or column, row and level
        size_t numbers;                ///< how many of them
        std::vector<std::vector<int32_t>> sizes;
    };
    constexpr int32_t least = std::numeric_limits<int32_t>::min();
    // Of deep blocks: the table's, the samples' (64 bits each).
    const std::vector<std::vector<int32_t>> deepSizes = {
        {0, 1, 100, 0},   {100, 0, 0, 1},       {0x70000000, 0, 100, 0},
        {-1, -1, 100, 0}, {-100, -1, 140, 0},   {140, 0, -100, -1},
        {-40, -1, 0, 0},  {0, least, 0, least}, {0, 0x10000000, 100, 0}};
    const std::vector<Case> cases = {{{0, 16}, 2, {{-1}, {least}, {0x7fffffff}, {1 << 20}}},
                                     {{1, 1, 1, 0, 0}, 5, {{-1}, {least}, {0x7fffffff}, {1 << 20}}},
                                     {{2, 16}, 2, deepSizes},
                                     {{3, 1, 1, 0, 0}, 5, deepSizes},
                                     {{4, 13}, 2, {{-1}, {least}, {0x7fffffff}, {1 << 20}}}};
    const size_t before = peakOfProcess();
    for (const Case& each : cases) {
        const std::string begin(reinterpret_cast<const char*>(each.begin.data()), 4 * each.numbers);
        const size_t at = whole.find(begin);
        ASSERT_NE(at, std::string::npos);
        ASSERT_EQ(whole.find(begin, at + 1), std::string::npos) << "not only a block begins with this";
        for (const std::vector<int32_t>& sizes : each.sizes) {
            SCOPED_TRACE(testing::Message() << "part " << each.begin[0] << ": " << sizes[0]);
            std::string bytes = whole;
            std::memcpy(bytes.data() + at + begin.size(), sizes.data(), 4 * sizes.size());
            ExrDocument document = ExrDocument::decode(test::toByteVector(bytes), "damaged.exr");
            const size_t changed = each.begin[0] == 0 ? 1 : 0;
            document.replace(changed, "R", std::vector<float>(20 * 18));
            std::filesystem::remove(path());
            EXPECT_THROW(document.write(path()), InputError);
            EXPECT_FALSE(std::filesystem::exists(path()));
        }
    }
    EXPECT_LT(peakOfProcess() - before, size_t{200} << 20);
}

/// Overwrites the first numbers of all attributes of this name and type, each in a copy of the file.
std::vector<std::string> patched(const std::string& whole, const std::string& name, const std::string& type,
                                 const std::vector<int32_t>& numbers) {
    std::vector<std::string> files;
    const std::string key = name + '\0' + type + '\0';
    for (size_t at = whole.find(key); at != std::string::npos; at = whole.find(key, at + 1)) {
        files.push_back(whole);
        std::memcpy(files.back().data() + at + key.size() + 4, numbers.data(), 4 * numbers.size());
    }
    return files;
}

TEST_F(ExrDocumentDamaged, AbsurdSizesAreRefusedWithoutAllocatingThem) {
    constexpr int32_t huge = std::numeric_limits<int32_t>::max(), far = 1 << 27;
    const std::vector<std::vector<int32_t>> windows = {
        {0, 0, 59999, 59999}, {0, 0, 16383, 16383}, {0, 0, huge, huge}, {-huge, -huge, huge, huge},
        {0, 0, huge, 0},      {0, 0, 0, huge},      {0, 0, far, 17},    {0, 0, 19, far},
        {-far, 0, far, 0},    {0, -far, 0, far},    {0, 0, far, far},   {5, 5, 4, 4}};
    const size_t before = peakOfProcess();
    for (const std::string& whole : {scanLines(), tiles()}) {
        for (const auto& window : windows) {
            const std::string bytes = patched(whole, "dataWindow", "box2i", window).at(0);
            EXPECT_THROW(ExrDocument::decode(test::toByteVector(bytes), "absurd.exr"), InputError);
        }
    }
    Outcomes outcomes;
    const std::string several = parts();
    const auto addAll = [&](const std::vector<std::string>& files, size_t count) {
        EXPECT_EQ(files.size(), count);
        for (const std::string& bytes : files) outcomes.add(bytes, path());
    };
    for (const auto& window : windows) {
        addAll(patched(several, "dataWindow", "box2i", window), 5);
        addAll(patched(several, "displayWindow", "box2i", window), 5);
    }
    for (const auto& sizes : std::vector<std::vector<int32_t>>{
             {huge, huge}, {huge, 8}, {16, huge}, {-1, -1}, {1, 1}, {1 << 16, 1 << 16}, {0, 0}})
        addAll(patched(several, "tiles", "tiledesc", sizes), 2);
    for (const int32_t count : {huge, -1, 0, far}) addAll(patched(several, "chunkCount", "int", {count}), 5);
    // A wrong size makes OpenEXR take the value's end for the next attribute: a text of 2 GB.
    const std::string text = std::string("a\0string\0", 9) + rawBytes(huge - 1000);
    for (const std::string& type : {std::string("int"), std::string("float"), std::string("v2i")}) {
        std::string bytes = scanLines();
        std::string value(type == "v2i" ? 8 : 4, 'x');
        value += text;
        bytes.insert(8, "_" + std::string(1, '\0') + type + '\0' + rawBytes(uint32_t(value.size())) + value);
        EXPECT_THROW(ExrDocument::decode(test::toByteVector(bytes), "absurd.exr"), InputError);
    }
    EXPECT_GT(outcomes.refused, 100u);
    EXPECT_LT(peakOfProcess() - before, size_t{200} << 20);
}

/// Like patched(), but all of them in one copy.
std::string patchedTogether(std::string file, const std::string& name, const std::string& type,
                            const std::vector<int32_t>& numbers) {
    const std::string key = name + '\0' + type + '\0';
    for (size_t at = file.find(key); at != std::string::npos; at = file.find(key, at + 1))
        std::memcpy(file.data() + at + key.size() + 4, numbers.data(), 4 * numbers.size());
    return file;
}

/// Returns why the file is refused, or "none".
std::string faultOf(const std::string& bytes) {
    try {
        ExrDocument::decode(test::toByteVector(bytes), "frame.exr");
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

TEST_F(ExrDocumentDamaged, TheFrameOfAPartThatCannotBeReadIsCheckedToo) {
    constexpr int32_t far = 1 << 27;
    const std::vector<std::pair<std::vector<int32_t>, std::string>> windows = {
        {{0, 0, 16383, 16383}, "has a frame of 16384x16384 pixels around 20x18 stored ones"},
        {{0, 0, far, 17}, "pixels are accepted"},
        {{0, 0, far, far}, "pixels are accepted"},
        {{5, 5, 4, 4}, "has an empty picture window"},
        {{0, 0, 20, 17}, "none"}};
    Imf::Header luma = small("luma", Imf::SCANLINEIMAGE, Imf::NO_COMPRESSION);
    luma.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
    const Imf::Header rows = small("rows", Imf::SCANLINEIMAGE, Imf::ZIP_COMPRESSION);
    const size_t before = peakOfProcess();
    for (const Imf::Header& first : {small("deep", Imf::DEEPSCANLINE, Imf::ZIPS_COMPRESSION), luma}) {
        for (const bool alone : {true, false}) {
            writeParts(path(), alone ? std::vector{first} : std::vector{first, rows});
            const std::string whole = test::get(path());
            EXPECT_EQ(faultOf(whole), "none");
            for (const auto& [window, fault] : windows) {
                const std::string found = faultOf(patchedTogether(whole, "displayWindow", "box2i", window));
                EXPECT_NE(found.find(fault), std::string::npos) << found << ", alone: " << alone;
            }
        }
        for (const std::string& bytes : patched(test::get(path()), "displayWindow", "box2i", {0, 0, 20, 17}))
            EXPECT_NE(faultOf(bytes).find("different display windows"), std::string::npos);
    }
    EXPECT_LT(peakOfProcess() - before, size_t{200} << 20);
}

TEST_F(ExrDocumentDamaged, APartThatCannotBeReadMayBeASmallCrop) {
    const Box2i frame({0, 0}, {4199, 4199});
    Imf::Header deep = small("deep", Imf::DEEPSCANLINE, Imf::ZIPS_COMPRESSION);
    Imf::Header rows = small("rows", Imf::SCANLINEIMAGE, Imf::ZIP_COMPRESSION);
    deep.displayWindow() = rows.displayWindow() = frame;
    rows.dataWindow() = Box2i({0, 0}, {599, 599});
    writeParts(path(), {deep, rows});
    EXPECT_EQ(faultOf(test::get(path())), "none");
    writeParts(path(), {deep});
    EXPECT_NE(faultOf(test::get(path())).find("around 20x18 stored ones"), std::string::npos);
}

}  // namespace
}  // namespace limpid::image
