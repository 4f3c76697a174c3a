// Reflection of SPIR-V: at build time, and where the viewer compiles a shader anew.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gpu/graph/shader.h"

namespace limpid::gpu {

/// Reads with SPIRV-Cross what the SPIR-V declares, used or not (glslc without -O keeps unused ones). The
/// result owns all that its ShaderCode views. A buffer block is named by its instance, or by the block if it
/// has none. Constants that have no GLSL name are left out. Throws Error naming the shader if it uses what
/// Limpid does not (sampled images, push constants, arrays of resources, another set than 0, an unlisted
/// format, several uniform blocks, two variables at one binding), or if the SPIR-V has lost its names (by
/// stripping, say).
std::shared_ptr<const ShaderCode> reflect(std::string name, std::vector<uint32_t> words);

}  // namespace limpid::gpu
