// Writes shaders as C++ source, which cmake/shader.cpp.in includes.
#pragma once

#include <iosfwd>
#include <span>

#include "gpu/graph/shader.h"

namespace limpid::gpu {

/// Writes `constexpr uint32_t words[]`, eight per line.
void writeWords(std::ostream& out, std::span<const uint32_t> words);

/// Writes `constexpr gpu::ShaderReflection reflection` and the tables it views, for use inside namespace
/// limpid.
void writeReflection(std::ostream& out, const ShaderReflection& reflection);

/// Writes `constexpr uint64_t hash`.
void writeHash(std::ostream& out, uint64_t hash);

}  // namespace limpid::gpu
