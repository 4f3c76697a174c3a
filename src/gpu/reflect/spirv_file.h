// SPIR-V in files, as glslc and spirv-opt write it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace limpid::gpu {

/// Throws Error naming the file if it cannot be read, is empty, or holds no whole number of words.
std::vector<uint32_t> readSpirv(const std::filesystem::path& file);

}  // namespace limpid::gpu
