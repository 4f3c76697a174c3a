// Hashes shaders to identify them.
#pragma once

#include <cstdint>
#include <span>

#include "gpu/graph/shader_code.h"

namespace limpid::gpu {

/// Returns the FNV-1a hash, 64 bits (http://www.isthe.com/chongo/tech/comp/fnv/), of the words and of the
/// whole reflection. The reflection matters because optimised words lack declarations that the shader does
/// not use.
uint64_t hashOf(std::span<const uint32_t> words, const ShaderReflection& reflection);

}  // namespace limpid::gpu
