// What tells shaders apart.
#pragma once

#include <cstdint>
#include <span>

#include "gpu/graph/shader.h"

namespace limpid::gpu {

/// FNV-1a, 64 bits (http://www.isthe.com/chongo/tech/comp/fnv/), of the words and of all that `reflection`
/// says. Of the latter, too, since optimised words do not tell what the shader declares and does not use.
uint64_t hashOf(std::span<const uint32_t> words, const ShaderReflection& reflection);

}  // namespace limpid::gpu
