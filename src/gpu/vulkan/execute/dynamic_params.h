// Keeps lavapipe from compiling shaders again for each dispatch.
//
// Mesa's lavapipe (lvp_inline_uniforms.c, seen in 22.3, which Debian 12 has) puts values of uniform blocks
// into shaders whose branches and loops depend on nothing else, optimises them and compiles them, at each
// dispatch, and frees none of that: a frame of `nano` takes 0.2 s and 20 MB more. It does so only for blocks
// whose number it knows when it compiles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace limpid::gpu {

/// Returns the compute shader with its uniform block in an array of one block, indexed by 0 as a number that
/// only the dispatch tells. The shader computes the same; the descriptor stays as it is. Needs the feature
/// shaderUniformBufferArrayDynamicIndexing. Shaders without a uniform block, or with several, and what is no
/// SPIR-V are returned unchanged.
std::vector<uint32_t> withDynamicParams(std::span<const uint32_t> words);

}  // namespace limpid::gpu
