// Reads SPIR-V files written by glslc and spirv-opt.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace limpid::gpu {

/// Throws Error naming the file if it cannot be read, is empty, or its size is not a multiple of four bytes.
std::vector<uint32_t> readSpirv(const std::filesystem::path& file);

}  // namespace limpid::gpu
