// Prepares SPIR-V for tools that do not know cooperative matrices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace limpid::gpu {

/// Returns the module without cooperative matrices (SPV_NV_cooperative_matrix), which SPIRV-Cross of Debian
/// 12 cannot read: removes their types, everything built from these, and the code in functions. The module's
/// external declarations stay. A module without such matrices is returned unchanged.
std::vector<uint32_t> withoutCooperativeMatrices(std::span<const uint32_t> words);

}  // namespace limpid::gpu
