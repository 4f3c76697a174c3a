#include "gpu/graph/shader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "gpu/vulkan/memory/format.h"
#include "test_group_size.comp.h"
#include "test_scale.comp.h"

namespace limpid::gpu {
namespace {

using testing::HasSubstr;

TEST(EmbeddedShader, HasItsTable) {
    const ShaderCode& code = shaders::test_scale_comp;
    EXPECT_EQ(code.name, "gpu/tests/shaders/test_scale.comp");
    const ShaderBinding* source = code.reflection.find("source");
    ASSERT_TRUE(source);
    EXPECT_TRUE(source->readable && !source->writable);
    EXPECT_EQ(code.reflection.find("nothing"), nullptr);
    EXPECT_EQ(code.reflection.constants.size(), 3u);
    EXPECT_EQ(shaders::test_group_size_comp.reflection.workgroupSizeIds[1], 1u);
    EXPECT_NE(code.hash, shaders::test_group_size_comp.hash);
}

// Tables must be usable as constants.
constexpr ShaderBinding image{"image", 0, BindingKind::StorageImage, Format::R32Float, true, false, 0};
constexpr ShaderBinding block{"params", 2, BindingKind::UniformBuffer, Format::RGBA32Float, true, false, 16};
constexpr ShaderConstant constant{"count", 3};
constexpr ShaderReflection first{ShaderStage::RayGeneration, {&block, 1}, {&constant, 1}};
static_assert(first.bindings[0].name == "params");

ShaderReflection declaring(const ShaderBinding& binding) {
    return {ShaderStage::Miss, {&binding, 1}, {}};
}

std::string faultOfMerging(const ShaderReflection& a, const ShaderReflection& b) {
    MergedDeclarations merged;
    merge(merged, a, "one");
    try {
        merge(merged, b, "other");
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

TEST(Merge, ListsWhatEachStageDeclaresByNumber) {
    MergedDeclarations merged;
    merge(merged, first, "one");
    merge(merged, declaring(image), "other");
    EXPECT_THAT(merged.bindings, testing::ElementsAre(image, block));
    EXPECT_THAT(merged.constants, testing::ElementsAre(constant));
}

TEST(Merge, OneBindingReadsAndWritesWhatAnyStageDoes) {
    ShaderBinding written = image;
    written.readable = false;
    written.writable = true;
    MergedDeclarations merged;
    merge(merged, declaring(image), "one");
    merge(merged, declaring(written), "other");
    ASSERT_EQ(merged.bindings.size(), 1u);
    EXPECT_TRUE(merged.bindings[0].readable && merged.bindings[0].writable);
}

TEST(Merge, RefusesStagesThatDisagree) {
    const auto fault = [](auto ShaderBinding::*member, auto value) {
        ShaderBinding changed = block;
        changed.*member = value;
        return faultOfMerging(first, declaring(changed));
    };
    EXPECT_EQ(faultOfMerging(first, first), "no error");
    const auto refused = HasSubstr("shader 'other' declares 'params' otherwise");
    EXPECT_THAT(fault(&ShaderBinding::binding, 1u), refused);
    EXPECT_THAT(fault(&ShaderBinding::kind, BindingKind::StorageBuffer), refused);
    EXPECT_THAT(fault(&ShaderBinding::blockSize, 20u), refused);
    EXPECT_THAT(fault(&ShaderBinding::name, "other"), HasSubstr("declares 'other' otherwise"));
    const ShaderConstant moved{"count", 4};
    EXPECT_THAT(faultOfMerging(first, {ShaderStage::Miss, {}, {&moved, 1}}),
                HasSubstr("declares 'count' otherwise"));
}

TEST(SameInterface, ComparesEveryFact) {
    EXPECT_TRUE(sameInterface(first, first));
    ShaderReflection other = first;
    other.stage = ShaderStage::Miss;
    EXPECT_FALSE(sameInterface(first, other));
    other = first;
    other.constants = {};
    EXPECT_FALSE(sameInterface(first, other));
    other = first;
    other.bindings = {&image, 1};
    EXPECT_FALSE(sameInterface(first, other));
    other = first;
    other.workgroupSize[0] = 8;
    EXPECT_FALSE(sameInterface(first, other));
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
