// Reflects SPIR-V: at build time, and when the viewer recompiles a shader.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gpu/graph/shader.h"

namespace limpid::gpu {

/// Lists what the SPIR-V declares, used or not (glslc without -O keeps unused variables), using SPIRV-Cross.
/// The result owns all data that its ShaderCode views. A buffer block is named by its instance, or by the
/// block if it has none. Constants without a GLSL name are skipped. Throws Error naming the shader if it uses
/// a feature that Limpid does not support (sampled images, push constants, arrays of resources, a set other
/// than 0, an unlisted format, several uniform blocks, two variables at one binding), or if the SPIR-V has no
/// names, for example because it was stripped.
std::shared_ptr<const ShaderCode> reflect(std::string name, std::vector<uint32_t> words);

}  // namespace limpid::gpu
