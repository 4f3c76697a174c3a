// Tests files of sums: what was written is read back, and any other content is rejected.
#include "renderer/long/sums/accumulation_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "base/error.h"
#include "base/files/file.h"
#include "base/hash.h"
#include "renderer/long/checkpoint.h"
#include "renderer/long/sums/accumulation_fixture.h"

namespace limpid::test {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::byte>;

class AccumulationFileTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / fmt::format("limpid_sums_test.{}", ::getpid());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    Bytes encode(const AccumulationHeader& header, const FrameSums& sums) const {
        writeAccumulation(folder_ / "a.sums", header, sums);
        return readFile(folder_ / "a.sums");
    }
    /// Returns a file with this header, no sums, and the correct checksum.
    static Bytes withHeader(const std::string& json) {
        Bytes bytes;
        const auto append = [&](const void* data, size_t size) {
            const auto* first = static_cast<const std::byte*>(data);
            bytes.insert(bytes.end(), first, first + size);
        };
        const uint32_t version = 2, size = static_cast<uint32_t>(json.size());
        const uint64_t counts[3] = {};
        const uint8_t blocks = 0;
        append("LIMPIDAC", 8);
        append(&version, 4);
        append(&size, 4);
        append(json.data(), json.size());
        append(counts, sizeof counts);
        append(&blocks, 1);
        bytes.resize(bytes.size() + 8);
        mend(bytes);
        return bytes;
    }
    static void mend(Bytes& bytes) {
        Hash64 hash;
        hash.add(std::span(bytes).first(bytes.size() - 8));
        const uint64_t value = hash.value();
        std::memcpy(&bytes[bytes.size() - 8], &value, 8);
    }
    static std::string faultOf(const Bytes& bytes) {
        try {
            decodeAccumulation(bytes, "x.sums");
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    }
    static std::string replaced(std::string text, const std::string& what, const std::string& by) {
        const size_t at = text.find(what);
        if (at == std::string::npos) throw Error(what + " is not in " + text);
        return text.replace(at, what.size(), by);
    }

    fs::path folder_;
};

TEST_F(AccumulationFileTest, ComesBackAsItWas) {
    AccumulationHeader header = smallHeader();
    for (const std::vector<std::string>& layers : {std::vector<std::string>{}, allLayers, {"depth", "id"}}) {
        header.layers = layers;
        for (const std::vector<uint32_t>& blocks :
             std::vector<std::vector<uint32_t>>{{}, {1}, {0, 2}, {0, 1, 2}}) {
            const FrameSums sums = randomSums(header, blocks);
            const Bytes bytes = encode(header, sums);
            const Accumulation back = decodeAccumulation(bytes, "x");
            expectSame(back.sums, sums);
            EXPECT_EQ(toJson(back.header), toJson(header));
            expectSame(readAccumulation(folder_ / "a.sums").sums, sums);
        }
    }
}

TEST_F(AccumulationFileTest, HeadersComeBackAsTheyWere) {
    AccumulationHeader header = smallHeader();
    header.identity.emplace_back("quote \" and ü", "back\\slash\n");
    header.frames = 1000;
    header.shard = {2, 3};
    header.frame = 4;
    header.finished = {{0, 0}, {2, 9}};
    header.floatColors = true;
    header.exposure = "-1.5";
    const AccumulationHeader back = headerFromJson(toJson(header), "x");
    EXPECT_EQ(toJson(back), toJson(header));
    EXPECT_EQ(back.identity, header.identity);
    EXPECT_EQ(back.finished, header.finished);
    EXPECT_EQ(back.shard, header.shard);
    EXPECT_EQ(firstDifference(back, header), std::nullopt);
}

TEST_F(AccumulationFileTest, CutOffAnywhereItIsRefused) {
    const AccumulationHeader header = smallHeader();
    const Bytes bytes = encode(header, randomSums(header, {0, 1}));
    for (size_t size = 0; size < bytes.size(); ++size)
        EXPECT_NE(faultOf(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size))), "none");
    Bytes longer = bytes;
    longer.push_back(std::byte{0});
    EXPECT_NE(faultOf(longer), "none");
}

TEST_F(AccumulationFileTest, AnyDamagedByteIsRefused) {
    AccumulationHeader header = smallHeader();
    header.layers = {"id"};
    Bytes bytes = encode(header, randomSums(header, {0, 1}));
    for (size_t at = 0; at < bytes.size(); ++at) {
        for (const unsigned mask : {0x01u, 0x80u, 0xFFu}) {
            bytes[at] ^= static_cast<std::byte>(mask);
            EXPECT_NE(faultOf(bytes), "none") << at;
            bytes[at] ^= static_cast<std::byte>(mask);
        }
    }
    EXPECT_EQ(faultOf(bytes), "none");
}

TEST_F(AccumulationFileTest, DamageWithARightChecksumIsReadOrRefusedAndNothingElse) {
    AccumulationHeader header = smallHeader();
    header.layers = {"id", "variance"};
    Bytes bytes = encode(header, randomSums(header, {0, 1}));
    size_t refused = 0, read = 0;
    for (size_t at = 0; at + 8 < bytes.size(); ++at) {
        bytes[at] ^= std::byte{0x15};
        mend(bytes);
        try {
            const Accumulation back = decodeAccumulation(bytes, "x");
            if (back.sums.samples() > 0) back.sums.means();
            ++read;
        } catch (const InputError&) {
            ++refused;
        }
        bytes[at] ^= std::byte{0x15};
    }
    EXPECT_GT(refused, 100u);
    EXPECT_GT(read, 100u);
}

TEST_F(AccumulationFileTest, HostileHeadersAreRefusedBeforeMemoryIsAskedFor) {
    const std::string json = toJson(smallHeader());
    EXPECT_EQ(faultOf(withHeader(json)), "none");
    const std::vector<std::array<std::string, 3>> faults{
        {"\"width\":3", "\"width\":0", "width"},
        {"\"width\":3", "\"width\":65536", "width"},
        {"\"width\":3", "\"width\":-3", "width"},
        {"\"width\":3", "\"width\":3.5", "width"},
        {"\"width\":3", "\"width\":\"3\"", "width"},
        {"\"width\":3", "\"breadth\":3", "width"},
        {"\"width\":3,\"height\":2", "\"width\":65535,\"height\":65535", "too large"},
        {"\"samples\":40", "\"samples\":0", "samples"},
        {"\"samples\":40", "\"samples\":16777217", "samples"},
        {"\"samples\":40", "\"samples\":16777216", "too early"},
        {"\"block_samples\":16", "\"block_samples\":0", "block_samples"},
        {"\"launch_samples\":1", "\"launch_samples\":17", "launch_samples"},
        {"\"layers\":[]", "\"layers\":[\"colour\"]", "colour"},
        {"\"layers\":[]", "\"layers\":[\"depth\",\"depth\"]", "depth"},
        {"\"layers\":[]", "\"layers\":{}", "layers"},
        {"\"shard\":1", "\"shard\":2", "shard"},
        {"\"shards\":1", "\"shards\":0", "shards"},
        {"\"frame\":0", "\"frame\":1", "frame"},
        {"\"finished\":[]", "\"finished\":[[0,1]]", "finished"},
        {"\"finished\":[]", "\"finished\":[[0]]", "finished"},
        {"\"finished\":[]", "\"finished\":[[0,0],[0,0]]", "finished"},
        {"\"identity\":[", "\"identity\":[1,", "identity"},
        {"\"identity\":[", "\"identity\":[[\"seed\",\"0\"],", "twice"},
        {"\"float\":false", "\"float\":0", "float"},
        {"\"exposure\":\"auto\"", "\"exposure\":[]", "exposure"},
        {"\"exposure\":\"auto\"", "\"exposure\":\"bright\"", "has an invalid exposure: 'bright'"},
        {"\"exposure\":\"auto\"", "\"exposure\":\"1e9\"", "has an invalid exposure: '1e9'"},
        {"\"tone_curve\":\"standard\"", "\"tone_curve\":[]", "tone_curve"},
        {"\"tone_curve\":\"standard\"", "\"tone_curve\":\"sepia\"", "has an unknown tone curve: 'sepia'"},
        {"{", "[", "header"},
    };
    for (const auto& [what, by, part] : faults) {
        EXPECT_THAT(faultOf(withHeader(replaced(json, what, by))),
                    testing::AllOf(testing::StartsWith("x.sums: "), testing::HasSubstr(part)))
            << by;
    }
    EXPECT_NE(faultOf(withHeader(std::string(100000, '['))), "none");
    EXPECT_NE(faultOf(withHeader("")), "none");
}

TEST_F(AccumulationFileTest, ABlockOfAnotherShardIsRefused) {
    AccumulationHeader header = smallHeader();
    header.shard = {2, 3};
    EXPECT_EQ(faultOf(encode(header, randomSums(header, {1}))), "none");
    EXPECT_THAT(faultOf(encode(header, randomSums(header, {0}))), testing::HasSubstr("shard"));
}

TEST_F(AccumulationFileTest, WhatIsNoFileIsNamed) {
    EXPECT_THROW(readAccumulation(folder_ / "none.sums"), InputError);
    EXPECT_THROW(readAccumulation(folder_), InputError);
    EXPECT_THROW(writeAccumulation(folder_ / "no/such.sums", smallHeader(), randomSums(smallHeader(), {})),
                 OutputError);
    FrameSums part = randomSums(smallHeader(), {});
    part.addPart(3, [&](const LayerInfo& layer) { return randomMeans(layer, 0, 6); });
    EXPECT_THROW(writeAccumulation(folder_ / "b.sums", smallHeader(), part), Error);
    EXPECT_FALSE(fs::exists(folder_ / "b.sums"));
}

TEST_F(AccumulationFileTest, ACheckpointThatCannotBeWrittenDoesNotEndTheRender) {
    const fs::path disk = folder_ / "disk";
    fs::create_directory(disk);
    Checkpoint checkpoint(disk / "a.ck");
    fs::remove(disk);
    const AccumulationHeader header = smallHeader();
    EXPECT_NO_THROW(checkpoint.saveIfDue(header, randomSums(header, {0})));
    EXPECT_FALSE(checkpoint.isDue()) << "it waits";
    EXPECT_FALSE(checkpoint.saveLast(header, randomSums(header, {0})));
    EXPECT_FALSE(checkpoint.exists());
    fs::create_directory(disk);
    EXPECT_TRUE(checkpoint.saveLast(header, randomSums(header, {0})));
    EXPECT_TRUE(checkpoint.exists());
}

TEST_F(AccumulationFileTest, ACheckpointOfAnotherRenderIsRefusedWithWhatDiffers) {
    const AccumulationHeader saved = smallHeader();
    Checkpoint checkpoint(folder_ / "a.ck");
    EXPECT_FALSE(checkpoint.exists());
    EXPECT_TRUE(checkpoint.saveLast(saved, randomSums(saved, {0})));
    EXPECT_EQ(checkpoint.load(saved).sums.blockCount(), 1u);
    const auto fault = [&](auto change) -> std::string {
        AccumulationHeader ours = saved;
        change(ours);
        try {
            checkpoint.load(ours);
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    };
    using Header = AccumulationHeader;
    EXPECT_THAT(fault([](Header& h) { h.identity[1].second = "1"; }), testing::HasSubstr("seed is 0, not 1"));
    EXPECT_THAT(fault([](Header& h) { h.identity[0].second = "b"; }), testing::HasSubstr("the scene"));
    EXPECT_THAT(fault([](Header& h) { h.identity.pop_back(); }), testing::HasSubstr("does not know"));
    EXPECT_THAT(fault([](Header& h) { h.extent.width = 4; }), testing::HasSubstr("width is 3, not 4"));
    EXPECT_THAT(fault([](Header& h) { h.extent.height = 4; }), testing::HasSubstr("height"));
    EXPECT_THAT(fault([](Header& h) { h.plan.samples = 41; }), testing::HasSubstr("samples is 40, not 41"));
    EXPECT_THAT(fault([](Header& h) { h.plan.launchSamples = 2; }), testing::HasSubstr("per launch"));
    EXPECT_THAT(fault([](Header& h) { h.layers = {"depth"}; }), testing::HasSubstr("layers"));
    EXPECT_THAT(fault([](Header& h) { h.frames = 2; }), testing::HasSubstr("frames"));
    EXPECT_THAT(fault([](Header& h) { h.shard = {1, 2}; }), testing::HasSubstr("shard 1/1, not 1/2"));
    EXPECT_EQ(fault([](Header& h) { h.device = "another"; }), "none") << "a warning";
}

}  // namespace
}  // namespace limpid::test
