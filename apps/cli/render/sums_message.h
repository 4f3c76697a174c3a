// Sums of some blocks of a frame, from one process to another.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "renderer/long/sums/accumulation.h"

namespace limpid::cli {

std::vector<std::byte> encodeCounts(const SampleCounts& counts);
SampleCounts decodeCounts(std::span<const std::byte> bytes);

/// As they lie in memory; both processes run the same version of Limpid on the same render.
std::vector<std::byte> encodeSums(const FrameSums& sums);
/// `empty`: sums of the frame without blocks. Throws Error if the message is of another frame.
FrameSums decodeSums(std::span<const std::byte> bytes, FrameSums empty);

}  // namespace limpid::cli
