#include "neural/tensor_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "image/io/temp_folder.h"

namespace limpid::neural {
namespace {

using image::test::get;
using image::test::put;
using image::test::TempFolder;

/// Returns a file with the given header and elements.
std::string fileOf(const std::string& header, const std::string& data) {
    const uint64_t length = header.size();
    std::string text(8, '\0');
    std::memcpy(text.data(), &length, 8);
    return text + header + data;
}

const std::string onePoint5 = {0x00, 0x3E};  // a half

TEST(TensorFile, ReadsWhatOthersWrote) {
    const TempFolder folder;
    const auto path = folder / "a.safetensors";
    put(path, fileOf(R"({"b":{"dtype":"F32","shape":[1,2],"data_offsets":[2,10]},"__metadata__":{"who":"I"},)"
                     R"("a":{"dtype":"F16","shape":[],"data_offsets":[0,2]}}   )",
                     onePoint5 + std::string{0, 0, 0x20, 0x41, 0, 0, 0, '\xC0'}));
    const TensorFile file = readTensorFile(path);
    EXPECT_EQ(file.metadata, (std::map<std::string, std::string>{{"who", "I"}}));
    ASSERT_EQ(file.tensors.size(), 2u);
    EXPECT_EQ(valuesOf(file.tensors.at("a")), std::vector<float>{1.5f});
    EXPECT_EQ(file.tensors.at("b").shape, (std::vector<uint64_t>{1, 2}));
    EXPECT_EQ(valuesOf(file.tensors.at("b")), (std::vector<float>{10.0f, -2.0f}));
}

TEST(TensorFile, ComesBackAsItWasWritten) {
    const TempFolder folder;
    const auto path = folder / "a.safetensors";
    TensorFile file;
    file.metadata["scene"] = "a \"room\"";
    file.tensors["x"] = makeTensor(ElementType::Float32, {2, 1, 3}, {0.1f, -2, 3e30f, 4, 5, 6});
    file.tensors["h"] = makeTensor(ElementType::Float16, {3}, {0.1f, 65504, -3e-7f});
    file.tensors["empty"] = makeTensor(ElementType::Float16, {4, 0}, {});
    writeTensorFile(path, file);
    TensorFile read = readTensorFile(path);
    EXPECT_EQ(read.metadata.at("crc32").size(), 8u);
    read.metadata.erase("crc32");
    EXPECT_EQ(read.metadata, file.metadata);
    EXPECT_EQ(read.tensors, file.tensors);
    EXPECT_EQ(folder.files(), 1u);
}

TEST(TensorFile, HalvesAreTheNearest) {
    const std::vector<float> values{0.1f, 1.0f / 3.0f, 1234.5f, -7e-6f};
    const std::vector<float> halves = valuesOf(makeTensor(ElementType::Float16, {4}, values));
    for (size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(halves[i], values[i], std::max(std::abs(values[i]) / 2048.0f, 3e-8f)) << values[i];
}

TEST(TensorFile, IsWrittenByTheFormatsRules) {
    const TempFolder folder;
    const auto path = folder / "a.safetensors";
    TensorFile file;
    file.tensors["w"] = makeTensor(ElementType::Float32, {1}, {1.0f});
    writeTensorFile(path, file);
    const std::string text = get(path);
    uint64_t length = 0;
    std::memcpy(&length, text.data(), 8);
    EXPECT_EQ(length % 8, 0u) << "elements begin aligned";
    EXPECT_EQ(text.size(), 8 + length + 4);
    // CRC-32 of 00 00 80 3f.
    EXPECT_THAT(text, testing::HasSubstr(R"("crc32":"aca16a6a")"));
}

TEST(TensorFile, RefusesToWriteWhatDoesNotFit) {
    const TempFolder folder;
    TensorFile file;
    file.tensors["w"] = {ElementType::Float32, {2}, std::vector<std::byte>(4)};
    EXPECT_THROW(writeTensorFile(folder / "a.safetensors", file), Error);
    EXPECT_EQ(folder.files(), 0u);
    EXPECT_THROW(makeTensor(ElementType::Float32, {2, 2}, {1, 2, 3}), Error);
}

struct Bad {
    const char* name;
    std::string text;
    const char* fault;
};

class BadTensorFile : public testing::TestWithParam<Bad> {};

TEST_P(BadTensorFile, IsRefusedByNameAndFault) {
    const TempFolder folder;
    const auto path = folder / "bad.safetensors";
    put(path, GetParam().text);
    try {
        readTensorFile(path);
        FAIL() << "was read";
    } catch (const InputError& fault) {
        EXPECT_THAT(fault.what(), testing::HasSubstr("bad.safetensors"));
        EXPECT_THAT(fault.what(), testing::HasSubstr(GetParam().fault));
        EXPECT_EQ(fault.code(), ExitCode::BadInput);
    }
}

std::string tensor(const std::string& shape, const std::string& offsets, const std::string& type = "F16") {
    return R"({"dtype":")" + type + R"(","shape":)" + shape + R"(,"data_offsets":)" + offsets + "}";
}

std::string withA(const std::string& value, const std::string& data = onePoint5) {
    return fileOf(R"({"a":)" + value + "}", data);
}

std::string nameOf(const testing::TestParamInfo<Bad>& bad) {
    return bad.param.name;
}

INSTANTIATE_TEST_SUITE_P(
    Cases, BadTensorFile,
    testing::Values(
        Bad{"Empty", "", "shorter than 8"}, Bad{"HugeHeader", std::string(8, '\x7F') + "{}", "a header of"},
        Bad{"CutHeader", fileOf(R"({"a":1})", "").substr(0, 10), "cut off"},
        Bad{"NoJson", fileOf("{\"a\":", ""), "no JSON"},
        Bad{"NotUtf8", fileOf("{\"\xFF\":{}}", ""), "no JSON"},
        Bad{"Deep", fileOf(std::string(1 << 20, '['), ""), "no JSON"},
        Bad{"Array", fileOf("[]", ""), "no JSON object"},
        Bad{"Twice",
            fileOf(R"({"a":)" + tensor("[]", "[0,2]") + R"(,"a":)" + tensor("[]", "[0,2]") + "}", onePoint5),
            "twice"},
        Bad{"Number", withA("7"), "no JSON object"}, Bad{"NoType", withA(R"({"shape":[]})"), "no dtype"},
        Bad{"OtherType", withA(tensor("[]", "[0,2]", "BF16")), "BF16"},
        Bad{"NoShape", withA(R"({"dtype":"F16","data_offsets":[0,2]})"), "no shape"},
        Bad{"Negative", withA(tensor("[-1]", "[0,2]")), "whole numbers"},
        Bad{"Fraction", withA(tensor("[1.5]", "[0,2]")), "whole numbers"},
        Bad{"BeyondAnyNumber", withA(tensor("[99999999999999999999999]", "[0,2]")), "whole numbers"},
        Bad{"Overflow", withA(tensor("[4294967296,4294967296,2]", "[0,2]")), "does not fit"},
        Bad{"ManyDimensions", withA(tensor("[1,1,1,1,1,1,1,1,1]", "[0,2]")), "dimensions"},
        Bad{"OneOffset", withA(tensor("[]", "[0]")), "data_offsets"},
        Bad{"Backwards", withA(tensor("[]", "[2,0]")), "ends at byte"},
        Bad{"BeyondTheEnd", withA(tensor("[2]", "[0,4]")), "cut off"},
        Bad{"AnotherSize", withA(tensor("[2]", "[0,2]")), "does not fit"},
        Bad{"Gap", withA(tensor("[]", "[2,4]"), onePoint5 + onePoint5), "begins at byte 2"},
        Bad{"Overlap",
            fileOf(R"({"a":)" + tensor("[]", "[0,2]") + R"(,"b":)" + tensor("[]", "[0,2]") + "}", onePoint5),
            "begins at byte 0"},
        Bad{"Rest", withA(tensor("[]", "[0,2]"), onePoint5 + "x"), "end at byte 2 of 3"},
        Bad{"Metadata", fileOf(R"({"__metadata__":[]})", ""), "metadata"},
        Bad{"MetadataNumber", fileOf(R"({"__metadata__":{"x":1}})", ""), "is not a string"},
        Bad{"Damaged",
            fileOf(R"({"__metadata__":{"crc32":"00000001"},"a":)" + tensor("[]", "[0,2]") + "}", onePoint5),
            "damaged"}),
    nameOf);

TEST(TensorFile, IsMissedByName) {
    EXPECT_THROW(readTensorFile("/no/such/file.safetensors"), InputError);
}

}  // namespace
}  // namespace limpid::neural
