#include "gpu/reflect/shader_hash.h"

#include <gtest/gtest.h>

#include <set>

namespace limpid::gpu {
namespace {

TEST(ShaderHash, ChangesWithWordsAndWithEveryFactOfTheReflection) {
    const uint32_t words[] = {1, 2}, otherWords[] = {1, 3}, moreWords[] = {1, 2, 0};
    const ShaderBinding binding{"a", 1, BindingKind::StorageImage, Format::R32Float, true, false, 8};
    const ShaderConstant constant{"c", 4};
    const ShaderReflection base{ShaderStage::Compute, {&binding, 1}, {&constant, 1}, {8, 4, 1}};
    std::set<uint64_t> hashes{hashOf(words, base), hashOf(otherWords, base), hashOf(moreWords, base),
                              hashOf(std::span(words).first(1), base)};
    size_t count = 4;
    const auto add = [&](const ShaderReflection& reflection) {
        hashes.insert(hashOf(words, reflection));
        ++count;
    };
    const auto addBinding = [&](auto ShaderBinding::*member, auto value) {
        ShaderBinding changed = binding;
        changed.*member = value;
        ShaderReflection reflection = base;
        reflection.bindings = {&changed, 1};
        add(reflection);
    };
    addBinding(&ShaderBinding::name, "b");
    addBinding(&ShaderBinding::binding, 2u);
    addBinding(&ShaderBinding::kind, BindingKind::StorageBuffer);
    addBinding(&ShaderBinding::format, Format::R32Uint);
    addBinding(&ShaderBinding::readable, false);
    addBinding(&ShaderBinding::writable, true);
    addBinding(&ShaderBinding::blockSize, 12u);
    for (const ShaderConstant& changed : {ShaderConstant{"d", 4}, ShaderConstant{"c", 5}}) {
        ShaderReflection reflection = base;
        reflection.constants = {&changed, 1};
        add(reflection);
    }
    ShaderReflection changed = base;
    changed.stage = ShaderStage::Miss;
    add(changed);
    changed = base;
    changed.workgroupSize[1] = 8;
    add(changed);
    changed = base;
    changed.workgroupSizeIds[2] = 0;
    add(changed);
    changed = base;
    changed.bindings = {};
    add(changed);
    EXPECT_EQ(hashes.size(), count);
}

}  // namespace
}  // namespace limpid::gpu
