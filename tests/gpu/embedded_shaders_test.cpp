// Compares the tables of embedded shaders with reflection of the SPIR-V that they were made from, and with
// the embedded SPIR-V itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "gpu/reflect/reflect.h"
#include "gpu/reflect/shader_hash.h"
#include "gpu/reflect/spirv_file.h"
#include "shader_list.h"

namespace limpid {
namespace {

// From the SPIR-V specification: "Instructions", "Decoration", "Execution Mode".
enum : uint32_t {
    opSource = 3,
    opName = 5,
    opMemberName = 6,
    opString = 7,
    opLine = 8,
    opExecutionMode = 16,
    opDecorate = 71,
    opModuleProcessed = 330,
    decorationSpecId = 1,
    decorationBinding = 33,
    decorationDescriptorSet = 34,
    modeLocalSize = 17
};

/// A module's interface to Vulkan, without names.
struct Module {
    std::multiset<uint32_t> ops;
    std::set<uint32_t> bindings, constantIds, sets;
    std::vector<uint32_t> localSize;
};

Module scanned(std::span<const uint32_t> words) {
    Module module;
    for (size_t at = 5; at < words.size();) {
        const size_t length = words[at] >> 16;
        const std::span instruction = words.subspan(at, std::clamp<size_t>(length, 1, words.size() - at));
        const uint32_t op = words[at] & 0xFFFFu;
        module.ops.insert(op);
        at += instruction.size();
        if (op == opDecorate && length == 4) {
            if (instruction[2] == decorationBinding) module.bindings.insert(instruction[3]);
            if (instruction[2] == decorationSpecId) module.constantIds.insert(instruction[3]);
            if (instruction[2] == decorationDescriptorSet) module.sets.insert(instruction[3]);
        }
        if (op == opExecutionMode && length == 6 && instruction[2] == modeLocalSize)
            module.localSize.assign(instruction.begin() + 3, instruction.end());
    }
    return module;
}

std::string titled(const testing::TestParamInfo<shaders::Listed>& listed) {
    std::string title(listed.param.code->name.substr(listed.param.code->name.rfind('/') + 1));
    std::ranges::replace_if(
        title, [](char c) { return c == '.' || c == ' ' || c == '-'; }, '_');
    return title;
}

class EmbeddedShaders : public testing::TestWithParam<shaders::Listed> {
  protected:
    const gpu::ShaderCode& code = *GetParam().code;
    const std::vector<uint32_t> original = gpu::readSpirv(GetParam().spirv);
};

TEST_P(EmbeddedShaders, HaveTheTablesThatReflectionGives) {
    const auto reflected = gpu::reflect(std::string(code.name), original);
    EXPECT_TRUE(sameInterface(code.reflection, reflected->reflection));
    EXPECT_TRUE(std::ranges::equal(code.reflection.bindings, reflected->reflection.bindings));
    EXPECT_EQ(code.hash, gpu::hashOf(code.words, code.reflection));
}

TEST_P(EmbeddedShaders, AreStripped) {
    const Module embedded = scanned(code.words);
    ASSERT_TRUE(scanned(original).ops.contains(opName)) << "the test itself sees no names";
    for (const uint32_t op : {opSource, opName, opMemberName, opString, opLine, opModuleProcessed})
        EXPECT_FALSE(embedded.ops.contains(op)) << "instruction " << op;
    EXPECT_LT(code.words.size(), original.size());
}

/// The descriptor set's layout and the constants follow the table, so the code must not use more.
TEST_P(EmbeddedShaders, AskForNoMoreThanTheTableSays) {
    const Module embedded = scanned(code.words);
    std::set<uint32_t> bindings, constantIds;
    for (const gpu::ShaderBinding& binding : code.reflection.bindings) bindings.insert(binding.binding);
    for (const gpu::ShaderConstant& constant : code.reflection.constants) constantIds.insert(constant.id);
    for (const uint32_t id : code.reflection.workgroupSizeIds)
        if (id != gpu::ShaderReflection::noConstant) constantIds.insert(id);
    EXPECT_TRUE(std::ranges::includes(bindings, embedded.bindings));
    EXPECT_TRUE(std::ranges::includes(constantIds, embedded.constantIds));
    EXPECT_TRUE(std::ranges::all_of(embedded.sets, [](uint32_t set) { return set == 0; }));
    EXPECT_TRUE(embedded.localSize.empty() ||
                std::ranges::equal(embedded.localSize, code.reflection.workgroupSize));
}

INSTANTIATE_TEST_SUITE_P(All, EmbeddedShaders,
                         testing::ValuesIn(shaders::listed().begin(), shaders::listed().end()), titled);

/// Checked by hand against the sources, since tables and reflection might have the same error.
TEST(EmbeddedShaderTables, SayWhatTheSourcesSay) {
    const auto named = [](std::string_view name) {
        return std::ranges::find(shaders::listed(), name,
                                 [](const shaders::Listed& listed) { return listed.code->name; });
    };
    const auto level = named("denoise/methods/atrous/atrous_level.comp");
    const auto generation = named("passes/pathtrace/pathtrace.rgen");
    const auto end = shaders::listed().end();
    ASSERT_TRUE(level != end && generation != end);
    EXPECT_EQ(level->code->reflection.stage, gpu::ShaderStage::Compute);
    EXPECT_EQ(level->code->reflection.workgroupSize, (std::array<uint32_t, 3>{8, 8, 1}));
    EXPECT_EQ(generation->code->reflection.stage, gpu::ShaderStage::RayGeneration);
}

}  // namespace
}  // namespace limpid
