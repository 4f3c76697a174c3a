// Comparing, merging and replacing shaders. Needs neither a device nor SPIRV-Cross.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gpu/graph/shader_code.h"

namespace limpid::gpu {

/// True if the same bindings and dispatches work with both shaders.
bool sameInterface(const ShaderReflection& a, const ShaderReflection& b);

/// Replacement shaders, by the names of the shaders they replace. Each pointer owns all data that its
/// ShaderCode views.
using ShaderReplacements = std::map<std::string, std::shared_ptr<const ShaderCode>, std::less<>>;

/// The declarations of several stages of one pipeline, bindings sorted by number.
struct MergedDeclarations {
    std::vector<ShaderBinding> bindings;
    std::vector<ShaderConstant> constants;
};

/// Adds the declarations of a stage. Throws Error naming `shader`, which contains the stage, if it disagrees
/// with earlier stages about a binding or a constant.
void merge(MergedDeclarations& into, const ShaderReflection& stage, std::string_view shader);

}  // namespace limpid::gpu
