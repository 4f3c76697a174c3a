// Files of sums: checkpoints, and what a shard of a still writes.
//
// Little-endian: the eight characters "LIMPIDAC"; format version (uint32: 2); length of the header (uint32);
// the header, JSON (renderer/long/accumulation_header.h); rays, rejected samples, clamped means (uint64
// each); one bit per block, lowest first, whether it is in the sums, in whole bytes. Unless no block is: for
// each layer its sums (int128) by pixel and component; then, if the layers have "id" and block 0 is in,
// instance and material of each pixel (uint32). Last the Hash64 of all before it (uint64).
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "renderer/long/accumulation.h"
#include "renderer/long/accumulation_header.h"

namespace limpid {

struct Accumulation {
    AccumulationHeader header;
    FrameSums sums;
};

/// Writes under a temporary name, flushes, renames: the file that was there is whole until the new one is.
/// Throws OutputError if it cannot be written; Error if the sums are not of the header's size, plan and
/// layers, or end in a part of a block.
void writeAccumulation(const std::filesystem::path& path, const AccumulationHeader& header,
                       const FrameSums& sums);

/// Throws InputError if the file is missing, no such file, damaged or cut off anywhere. Allocates about as
/// much as the file is long.
Accumulation readAccumulation(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in messages.
Accumulation decodeAccumulation(std::span<const std::byte> bytes, const std::filesystem::path& name);

}  // namespace limpid
