#include "gpu/graph/shader.h"

#include <algorithm>

#include "base/error.h"
#include "base/text/format.h"

namespace limpid::gpu {

const ShaderBinding* ShaderReflection::find(std::string_view name) const {
    const auto found = std::ranges::find(bindings, name, &ShaderBinding::name);
    return found == bindings.end() ? nullptr : &*found;
}

bool sameInterface(const ShaderReflection& a, const ShaderReflection& b) {
    return a.stage == b.stage && a.workgroupSize == b.workgroupSize &&
           a.workgroupSizeIds == b.workgroupSizeIds && std::ranges::equal(a.bindings, b.bindings) &&
           std::ranges::equal(a.constants, b.constants);
}

namespace {

[[noreturn]] void failToMerge(std::string_view shader, std::string_view name) {
    throw Error(
        formatText("shader '{}' declares '{}' otherwise than the shader that calls it", shader, name));
}

void mergeBinding(std::vector<ShaderBinding>& into, const ShaderBinding& b, std::string_view shader) {
    const auto same = [&](const ShaderBinding& a) { return a.name == b.name || a.binding == b.binding; };
    const auto found = std::ranges::find_if(into, same);
    if (found == into.end()) {
        into.push_back(b);
        return;
    }
    if (found->name != b.name || found->binding != b.binding || found->kind != b.kind ||
        found->format != b.format || found->blockSize != b.blockSize) {
        failToMerge(shader, b.name);
    }
    found->readable |= b.readable;
    found->writable |= b.writable;
}

}  // namespace

void merge(MergedDeclarations& into, const ShaderReflection& stage, std::string_view shader) {
    for (const ShaderBinding& binding : stage.bindings) mergeBinding(into.bindings, binding, shader);
    std::ranges::sort(into.bindings, {}, &ShaderBinding::binding);
    for (const ShaderConstant& constant : stage.constants) {
        const auto found = std::ranges::find(into.constants, constant.name, &ShaderConstant::name);
        if (found == into.constants.end()) {
            into.constants.push_back(constant);
        } else if (found->id != constant.id) {
            failToMerge(shader, constant.name);
        }
    }
}

}  // namespace limpid::gpu
