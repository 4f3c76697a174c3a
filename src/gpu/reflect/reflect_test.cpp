#include "gpu/reflect/reflect.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "gpu/reflect/shader_hash.h"
#include "gpu/reflect/spirv_file.h"
#include "gpu/vulkan/memory/format.h"

namespace limpid::gpu {
namespace {

using testing::HasSubstr;

/// Reflects a shader of src/gpu/tests/shaders as glslc wrote it.
std::shared_ptr<const ShaderCode> reflected(const std::string& name) {
    return reflect(name, readSpirv(LIMPID_SPIRV "/" + name + ".spv"));
}

template <typename Callable>
std::string faultOf(Callable callable) {
    try {
        callable();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

std::string faultOf(const char* name) {
    return faultOf([&] { reflected(name); });
}

TEST(Reflect, ReadsImagesAndTheirQualifiers) {
    const auto code = reflected("test_scale.comp");
    const ShaderReflection& reflection = code->reflection;
    ASSERT_EQ(reflection.bindings.size(), 2u);
    const ShaderBinding* source = reflection.find("source");
    const ShaderBinding* result = reflection.find("result");
    ASSERT_TRUE(source && result);
    EXPECT_TRUE(source->readable && !source->writable);
    EXPECT_TRUE(!result->readable && result->writable);
    EXPECT_EQ(source->kind, BindingKind::StorageImage);
    EXPECT_EQ(result->binding, 1u);
    EXPECT_EQ(reflection.find("nothing"), nullptr);
    const auto both = reflected("test_increment.comp");
    ASSERT_FALSE(both->reflection.bindings.empty());
    EXPECT_TRUE(both->reflection.bindings[0].readable && both->reflection.bindings[0].writable);
}

TEST(Reflect, ReadsEveryFormat) {
    const auto code = reflected("test_formats.comp");
    const std::span<const ShaderBinding> bindings = code->reflection.bindings;
    ASSERT_EQ(bindings.size(), allFormats().size());
    for (size_t i = 0; i < bindings.size(); ++i)
        EXPECT_EQ(bindings[i].format, allFormats()[i]) << bindings[i].name;
}

TEST(Reflect, NamesBuffersByInstanceOrBlockAndReadsTheirQualifiers) {
    const auto code = reflected("test_buffers.comp");
    const ShaderReflection& reflection = code->reflection;
    const auto expect = [&](const char* name, BindingKind kind, bool readable, bool writable) {
        const ShaderBinding* binding = reflection.find(name);
        ASSERT_TRUE(binding) << name;
        EXPECT_EQ(binding->kind, kind) << name;
        EXPECT_EQ(binding->readable, readable) << name;
        EXPECT_EQ(binding->writable, writable) << name;
    };
    ASSERT_EQ(reflection.bindings.size(), 5u);
    expect("texels", BindingKind::StorageTexelBuffer, true, false);
    expect("indices", BindingKind::StorageTexelBuffer, true, false);
    expect("offsets", BindingKind::StorageBuffer, true, false);
    expect("counter", BindingKind::StorageBuffer, true, true);
    expect("Sums", BindingKind::StorageBuffer, false, true);
    EXPECT_EQ(reflection.find("indices")->format, Format::R32Uint);
    EXPECT_EQ(reflection.workgroupSize, (std::array<uint32_t, 3>{64, 1, 1}));
}

TEST(Reflect, ReadsTheUniformBlocksSizeInScalarLayout) {
    const auto code = reflected("test_fill.comp");
    const ShaderBinding* params = code->reflection.find("params");
    ASSERT_TRUE(params);
    EXPECT_EQ(params->kind, BindingKind::UniformBuffer);
    EXPECT_EQ(params->blockSize, 28u);
}

TEST(Reflect, ReadsConstants) {
    const auto code = reflected("test_scale.comp");
    ASSERT_EQ(code->reflection.constants.size(), 3u);
    for (const ShaderConstant& constant : code->reflection.constants) {
        const uint32_t id = constant.name == "factor" ? 3 : constant.name == "bias" ? 5 : 7;
        EXPECT_EQ(constant.id, id) << constant.name;
    }
}

TEST(Reflect, ReadsAWorkgroupSizeOfConstants) {
    const auto code = reflected("test_group_size.comp");
    const ShaderReflection& reflection = code->reflection;
    EXPECT_EQ(reflection.workgroupSize, (std::array<uint32_t, 3>{8, 4, 1}));
    EXPECT_EQ(reflection.workgroupSizeIds, (std::array<uint32_t, 3>{0, 1, ShaderReflection::noConstant}));
    ASSERT_EQ(reflection.constants.size(), 2u);
    EXPECT_EQ(reflected("test_fill.comp")->reflection.workgroupSize, (std::array<uint32_t, 3>{8, 8, 1}));
}

TEST(Reflect, ListsUnusedVariables) {
    EXPECT_TRUE(reflected("test_unused.comp")->reflection.find("unused"));
}

TEST(Reflect, OwnsNameAndWords) {
    const std::vector<uint32_t> words = readSpirv(LIMPID_SPIRV "/test_fill.comp.spv");
    const auto code = reflect("a name too long to be kept inside of a std::string", words);
    EXPECT_EQ(code->name, "a name too long to be kept inside of a std::string");
    EXPECT_TRUE(std::ranges::equal(code->words, words));
    EXPECT_EQ(code->hash, hashOf(words, code->reflection));
}

TEST(Reflect, RefusesWhatLimpidDoesNotUse) {
    EXPECT_THAT(faultOf("test_sampled.comp"), HasSubstr("'picture': Limpid has no images with samplers"));
    EXPECT_THAT(faultOf("test_sampled.comp"), HasSubstr("shader 'test_sampled.comp'"));
    EXPECT_THAT(faultOf("test_set1.comp"), HasSubstr("'result': only descriptor set 0"));
    EXPECT_THAT(faultOf("test_array.comp"), HasSubstr("'results': arrays of resources"));
    EXPECT_THAT(faultOf("test_push.comp"), HasSubstr("push constants"));
    EXPECT_THAT(faultOf("test_rgba16.comp"), HasSubstr("'result' needs one of the formats"));
    EXPECT_THAT(faultOf("test_two_blocks.comp"), HasSubstr("more than one uniform block"));
}

TEST(Reflect, RefusesWhatIsStripped) {
    EXPECT_THAT(faultOf([] { reflect("bare", readSpirv(LIMPID_SPIRV "/test_fill.comp.embedded.spv")); }),
                HasSubstr("'bare': a variable has no name"));
}

TEST(Reflect, RefusesWhatIsNoSpirV) {
    EXPECT_THAT(faultOf([] {
                    reflect("broken", {1, 2, 3, 4, 5, 6});
                }),
                HasSubstr("'broken': SPIRV-Cross cannot read it"));
    EXPECT_THAT(faultOf([] { reflect("empty", {}); }), HasSubstr("'empty': SPIRV-Cross cannot read it"));
}

}  // namespace
}  // namespace limpid::gpu
