// SPIR-V for readers that do not know cooperative matrices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace limpid::gpu {

/// The module without what uses cooperative matrices (SPV_NV_cooperative_matrix), which SPIRV-Cross of Debian
/// 12 cannot read: their types, all that is made of these, and the code in functions. What a module declares
/// for the outside stays; one without such matrices stays as it is.
std::vector<uint32_t> withoutCooperativeMatrices(std::span<const uint32_t> words);

}  // namespace limpid::gpu
