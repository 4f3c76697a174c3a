// Tests the shaders that CPUs get (gpu/vulkan/execute/dynamic_params.h).
#include "gpu/vulkan/execute/dynamic_params.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "gpu/reflect/reflect.h"
#include "shader_list.h"

#if LIMPID_HAVE_SPIRV_TOOLS_OPT
#include <spirv-tools/libspirv.hpp>
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

#if LIMPID_HAVE_SPIRV_TOOLS_OPT
TEST(DynamicParams, AllShadersStayValid) {
    spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
    std::string fault;
    tools.SetMessageConsumer(
        [&](spv_message_level_t, const char*, const spv_position_t&, const char* text) { fault = text; });
    spvtools::ValidatorOptions options;
    options.SetScalarBlockLayout(true);
    for (const shaders::Listed& listed : shaders::listed()) {
        const Words result = gpu::withDynamicParams(listed.code->words);
        EXPECT_TRUE(tools.Validate(result.data(), result.size(), options))
            << listed.code->name << ": " << fault;
    }
}
#endif

}  // namespace
}  // namespace limpid::test
