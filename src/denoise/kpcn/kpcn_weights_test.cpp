// Tests that weight files are read, and that invalid ones are refused with a message that names the fault.
#include "denoise/kpcn/kpcn_weights.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "base/error.h"
#include "image/io/temp_folder.h"
#include "neural/tensor_file.h"

namespace limpid::denoise {
namespace {

using image::test::get;
using image::test::put;
using image::test::TempFolder;
using neural::ElementType;
using neural::TensorFile;
using testing::HasSubstr;

neural::Tensor filled(std::vector<uint64_t> shape, float value) {
    uint64_t count = 1;
    for (const uint64_t length : shape) count *= length;
    return neural::makeTensor(ElementType::Float32, std::move(shape), std::vector<float>(count, value));
}

/// Returns a valid file: a network with one hidden layer of two channels and kernels of 3x3 pixels.
TensorFile whole() {
    TensorFile file;
    file.metadata = {{"limpid.network", "kpcn"}, {"limpid.shape", R"({"hidden":1,"channels":2,"width":3})"}};
    for (const std::string side : {"diffuse", "specular"}) {
        file.tensors[side + ".hidden.0.weight"] = filled({2, 34, 5, 5}, 0.5f);
        file.tensors[side + ".hidden.0.bias"] = filled({2}, 0.25f);
        file.tensors[side + ".output.weight"] = filled({9, 2, 5, 5}, -1.0f);
        file.tensors[side + ".output.bias"] = filled({9}, 2.0f);
    }
    return file;
}

std::string faultOf(const TensorFile& file) {
    const TempFolder folder;
    neural::writeTensorFile(folder / "w.safetensors", file);
    try {
        readKpcnWeights(folder / "w.safetensors");
    } catch (const InputError& fault) {
        EXPECT_THAT(fault.what(), HasSubstr("w.safetensors"));
        return fault.what();
    }
    return "";
}

TEST(KpcnWeights, AreRead) {
    const TempFolder folder;
    neural::writeTensorFile(folder / "w.safetensors", whole());
    const KpcnWeights weights = readKpcnWeights(folder / "w.safetensors");
    EXPECT_EQ(weights.kernelWidth, 3u);
    for (const auto& side : weights.sides) {
        ASSERT_EQ(side.size(), 2u);
        EXPECT_EQ(side[0].inputs, 34u);
        EXPECT_EQ(side[0].outputs, 2u);
        EXPECT_EQ(side[1].outputs, 9u);
        EXPECT_EQ(side[1].weights, std::vector<float>(9 * 2 * 25, -1.0f));
        EXPECT_EQ(side[0].bias, std::vector<float>(2, 0.25f));
    }
    EXPECT_EQ(weights.facing, 0.5f);
    EXPECT_TRUE(weights.logarithmicDiffuse);
}

TEST(KpcnWeights, TheNetworkSaysWhatItsKernelsTakeIn) {
    const TempFolder folder;
    TensorFile file = whole();
    file.metadata["limpid.shape"] = R"({"hidden":1,"channels":2,"width":3,"facing":-2})";
    neural::writeTensorFile(folder / "w.safetensors", file);
    EXPECT_EQ(readKpcnWeights(folder / "w.safetensors").facing, -2.0f);
    file.metadata["limpid.shape"] = R"({"hidden":1,"channels":2,"width":3,"facing":0.98})";
    neural::writeTensorFile(folder / "w.safetensors", file);
    EXPECT_EQ(readKpcnWeights(folder / "w.safetensors").facing, 0.98f);
    file.metadata["limpid.shape"] = R"({"hidden":1,"channels":2,"width":3,"diffuse_input":"linear"})";
    neural::writeTensorFile(folder / "w.safetensors", file);
    EXPECT_FALSE(readKpcnWeights(folder / "w.safetensors").logarithmicDiffuse);
}

TEST(KpcnWeights, WhatIsWrongIsRefusedAndNamed) {
    const auto with = [](const std::function<void(TensorFile&)>& change) {
        TensorFile file = whole();
        change(file);
        return faultOf(file);
    };
    const auto shape = [&](const std::string& text) {
        return with([&](TensorFile& file) { file.metadata["limpid.shape"] = text; });
    };
    EXPECT_THAT(with([](TensorFile& f) { f.metadata.erase("limpid.network"); }),
                HasSubstr("no KPCN weights"));
    EXPECT_THAT(with([](TensorFile& f) { f.metadata["limpid.network"] = "other"; }),
                HasSubstr("no KPCN weights"));
    EXPECT_THAT(with([](TensorFile& f) { f.metadata.erase("limpid.shape"); }), HasSubstr("no KPCN weights"));
    EXPECT_THAT(shape("{"), HasSubstr("'hidden'"));
    EXPECT_THAT(shape("[1,2,3]"), HasSubstr("'hidden'"));
    EXPECT_THAT(shape(R"({"hidden":0,"channels":2,"width":3})"), HasSubstr("'hidden'"));
    EXPECT_THAT(shape(R"({"hidden":1,"channels":-2,"width":3})"), HasSubstr("'channels'"));
    EXPECT_THAT(shape(R"({"hidden":1,"channels":2,"width":4})"), HasSubstr("even"));
    EXPECT_THAT(shape(R"({"hidden":1,"channels":2,"width":1e3})"), HasSubstr("'width'"));
    EXPECT_THAT(shape(R"({"hidden":1,"channels":2,"width":99})"), HasSubstr("'width'"));
    for (const char* facing : {"-2.1", "0.99", "1.5", "1e300", "\"any\"", "null"})
        EXPECT_THAT(shape(fmt::format(R"({{"hidden":1,"channels":2,"width":3,"facing":{}}})", facing)),
                    HasSubstr("'facing'"));
    for (const char* input : {"\"square\"", "1", "null"})
        EXPECT_THAT(shape(fmt::format(R"({{"hidden":1,"channels":2,"width":3,"diffuse_input":{}}})", input)),
                    HasSubstr("'diffuse_input'"));
    EXPECT_THAT(shape(R"({"hidden":4000000000,"channels":2,"width":3})"), HasSubstr("'hidden'"));
    EXPECT_THAT(shape(R"({"hidden":2,"channels":2,"width":3})"),
                HasSubstr("lacks the tensor 'diffuse.hidden.1.weight'"));
    EXPECT_THAT(shape(R"({"hidden":1,"channels":3,"width":3})"),
                HasSubstr("(2, 34, 5, 5), not (3, 34, 5, 5)"));
    EXPECT_THAT(with([](TensorFile& f) { f.tensors.erase("specular.output.bias"); }),
                HasSubstr("'specular.output.bias'"));
    EXPECT_THAT(with([](TensorFile& f) { f.tensors["more"] = filled({1}, 0.0f); }), HasSubstr("'more'"));
    EXPECT_THAT(with([](TensorFile& f) {
                    f.tensors["diffuse.output.bias"] = filled({3, 3}, 0.0f);
                }),
                HasSubstr("(3, 3), not (9)"));
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e6f}) {
        EXPECT_THAT(with([&](TensorFile& f) { f.tensors["diffuse.output.bias"] = filled({9}, bad); }),
                    HasSubstr("half precision"));
    }
}

TEST(KpcnWeights, CutOffAnywhereTheyAreRefused) {
    const TempFolder folder;
    neural::writeTensorFile(folder / "w.safetensors", whole());
    const std::string bytes = get(folder / "w.safetensors");
    for (size_t length = 0; length < bytes.size(); length += 1 + length / 8) {
        put(folder / "cut.safetensors", bytes.substr(0, length));
        EXPECT_THROW(readKpcnWeights(folder / "cut.safetensors"), InputError) << length;
    }
    std::string other = bytes;
    other[bytes.size() - 5] ^= 1;
    put(folder / "cut.safetensors", other);
    EXPECT_THROW(readKpcnWeights(folder / "cut.safetensors"), InputError);
    EXPECT_THROW(readKpcnWeights(folder / "missing.safetensors"), InputError);
}

}  // namespace
}  // namespace limpid::denoise
