// Shaders as C++ source, for cmake/shader.cpp.in to include.
#pragma once

#include <iosfwd>
#include <span>

#include "gpu/graph/shader.h"

namespace limpid::gpu {

/// `constexpr uint32_t words[]`, eight to a line.
void writeWords(std::ostream& out, std::span<const uint32_t> words);

/// `constexpr gpu::ShaderReflection reflection`, with the tables that it views, for a place inside namespace
/// limpid.
void writeReflection(std::ostream& out, const ShaderReflection& reflection);

/// `constexpr uint64_t hash`.
void writeHash(std::ostream& out, uint64_t hash);

}  // namespace limpid::gpu
