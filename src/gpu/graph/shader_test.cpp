#include "gpu/graph/shader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "test_accumulate.comp.h"
#include "test_array.comp.h"
#include "test_buffers.comp.h"
#include "test_fill.comp.h"
#include "test_formats.comp.h"
#include "test_group_size.comp.h"
#include "test_increment.comp.h"
#include "test_push.comp.h"
#include "test_rgba16.comp.h"
#include "test_sampled.comp.h"
#include "test_scale.comp.h"
#include "test_set1.comp.h"
#include "test_two_blocks.comp.h"
#include "test_unused.comp.h"

namespace limpid::gpu {
namespace {

using testing::HasSubstr;

std::string faultOf(const ShaderCode& code) {
    try {
        reflect(code);
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Reflection, ReadsImagesAndTheirQualifiers) {
    const ShaderReflection reflection = reflect(shaders::test_scale_comp);
    ASSERT_EQ(reflection.bindings.size(), 2u);
    const ShaderBinding* source = reflection.find("source");
    const ShaderBinding* result = reflection.find("result");
    ASSERT_TRUE(source && result);
    EXPECT_TRUE(source->readable && !source->writable);
    EXPECT_TRUE(!result->readable && result->writable);
    EXPECT_EQ(source->kind, BindingKind::StorageImage);
    EXPECT_EQ(result->binding, 1u);
    EXPECT_EQ(reflection.find("nothing"), nullptr);
    const ShaderReflection both = reflect(shaders::test_increment_comp);
    EXPECT_TRUE(both.bindings.at(0).readable && both.bindings.at(0).writable);
}

TEST(Reflection, ReadsEveryFormat) {
    const ShaderReflection reflection = reflect(shaders::test_formats_comp);
    ASSERT_EQ(reflection.bindings.size(), allFormats().size());
    for (size_t i = 0; i < reflection.bindings.size(); ++i) {
        EXPECT_EQ(reflection.bindings[i].format, allFormats()[i]) << reflection.bindings[i].name;
    }
}

TEST(Reflection, NamesBuffersByInstanceOrBlockAndReadsTheirQualifiers) {
    const ShaderReflection reflection = reflect(shaders::test_buffers_comp);
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

TEST(Reflection, ReadsTheUniformBlocksSizeInScalarLayout) {
    const ShaderReflection reflection = reflect(shaders::test_fill_comp);
    const ShaderBinding* params = reflection.find("params");
    ASSERT_TRUE(params);
    EXPECT_EQ(params->kind, BindingKind::UniformBuffer);
    EXPECT_EQ(params->blockSize, 28u);
}

TEST(Reflection, ReadsConstants) {
    const ShaderReflection reflection = reflect(shaders::test_scale_comp);
    ASSERT_EQ(reflection.constants.size(), 3u);
    for (const ShaderConstant& constant : reflection.constants) {
        const uint32_t id = constant.name == "factor" ? 3 : constant.name == "bias" ? 5 : 7;
        EXPECT_EQ(constant.id, id) << constant.name;
    }
}

TEST(Reflection, ReadsAWorkgroupSizeOfConstants) {
    const ShaderReflection reflection = reflect(shaders::test_group_size_comp);
    EXPECT_EQ(reflection.workgroupSize, (std::array<uint32_t, 3>{8, 4, 1}));
    EXPECT_EQ(reflection.workgroupSizeIds, (std::array<uint32_t, 3>{0, 1, ShaderReflection::noConstant}));
    ASSERT_EQ(reflection.constants.size(), 2u);
    EXPECT_EQ(reflect(shaders::test_fill_comp).workgroupSize, (std::array<uint32_t, 3>{8, 8, 1}));
}

TEST(Reflection, ListsUnusedVariables) {
    EXPECT_TRUE(reflect(shaders::test_unused_comp).find("unused"));
}

TEST(Reflection, RefusesWhatLimpidDoesNotUse) {
    EXPECT_THAT(faultOf(shaders::test_sampled_comp),
                HasSubstr("'picture': Limpid has no images with samplers"));
    EXPECT_THAT(faultOf(shaders::test_sampled_comp), HasSubstr("gpu/tests/shaders/test_sampled.comp"));
    EXPECT_THAT(faultOf(shaders::test_set1_comp), HasSubstr("'result': only descriptor set 0"));
    EXPECT_THAT(faultOf(shaders::test_array_comp), HasSubstr("'results': arrays of resources"));
    EXPECT_THAT(faultOf(shaders::test_push_comp), HasSubstr("push constants"));
    EXPECT_THAT(faultOf(shaders::test_rgba16_comp), HasSubstr("'result' needs one of the formats"));
    EXPECT_THAT(faultOf(shaders::test_two_blocks_comp), HasSubstr("more than one uniform block"));
}

TEST(Reflection, RefusesWhatIsNoSpirV) {
    const uint32_t words[] = {1, 2, 3, 4, 5, 6};
    EXPECT_THAT(faultOf({"broken", words}), HasSubstr("'broken': SPIRV-Cross cannot read it"));
    EXPECT_THAT(faultOf({"empty", {}}), HasSubstr("'empty': SPIRV-Cross cannot read it"));
}

TEST(Formats, AreConsistent) {
    for (const Format format : allFormats()) {
        EXPECT_EQ(bytesPerTexel(format) % componentCount(format), 0u);
        EXPECT_FALSE(toString(format).empty());
    }
    EXPECT_EQ(bytesPerTexel(Format::RGBA16Float), 8u);
    EXPECT_EQ(componentCount(Format::RG32Uint), 2u);
}

}  // namespace
}  // namespace limpid::gpu
