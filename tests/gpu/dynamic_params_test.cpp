// Tests the shaders that CPUs get (gpu/vulkan/execute/dynamic_params.h).
#include "gpu/vulkan/execute/dynamic_params.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "gpu/reflect/reflect.h"
#include "shader_list.h"

#if LIMPID_HAVE_SPIRV_TOOLS_OPT
#include "tests/gpu/spirv_validator.h"
#endif

namespace limpid::test {
namespace {

using gpu::BindingKind;
using Words = std::vector<uint32_t>;

bool hasBlock(const gpu::ShaderCode& code) {
    return std::ranges::any_of(code.reflection.bindings, [](const gpu::ShaderBinding& binding) {
        return binding.kind == BindingKind::UniformBuffer;
    });
}

TEST(DynamicParams, OnlyComputeShadersWithABlockChange) {
    size_t changed = 0;
    for (const shaders::Listed& listed : shaders::listed()) {
        const Words before(listed.code->words.begin(), listed.code->words.end());
        const bool changes = gpu::withDynamicParams(before) != before;
        const bool isCompute = listed.code->reflection.stage == gpu::ShaderStage::Compute;
        EXPECT_TRUE(!changes || (isCompute && hasBlock(*listed.code))) << listed.code->name;
        changed += size_t{changes};
    }
    EXPECT_GT(changed, 40u);
}

TEST(DynamicParams, WhatIsNoSpirvStays) {
    const Words garbage(100, 0xDEADBEEFu), none;
    EXPECT_EQ(gpu::withDynamicParams(garbage), garbage);
    EXPECT_EQ(gpu::withDynamicParams(none), none);
}

/// Instructions without their operands, and modules that end too soon.
TEST(DynamicParams, WhatIsDamagedStays) {
    const std::span<const uint32_t> whole = shaders::listed().front().code->words;
    const Words header(whole.begin(), whole.begin() + 5);
    for (const uint32_t op : {15u, 20u, 21u, 23u, 32u, 59u, 61u, 65u, 66u, 71u}) {
        for (const uint32_t length : {0u, 1u, 2u, 3u, 9u}) {
            Words module = header;
            module.push_back(length << 16 | op);
            for (uint32_t i = 1; i < std::min(length, 4u); ++i) module.push_back(7);
            EXPECT_EQ(gpu::withDynamicParams(module), module) << op << " " << length;
        }
    }
    for (size_t length = 0; length < whole.size(); length += 97)
        EXPECT_NO_THROW(gpu::withDynamicParams(whole.first(length)));
}

#if LIMPID_HAVE_SPIRV_TOOLS_OPT
TEST(DynamicParams, AllShadersStayValid) {
    SpirvValidator validator;
    for (const shaders::Listed& listed : shaders::listed()) {
        const Words result = gpu::withDynamicParams(listed.code->words);
        EXPECT_TRUE(validator.accepts(result)) << listed.code->name << ": " << validator.fault();
    }
}
#endif

}  // namespace
}  // namespace limpid::test
