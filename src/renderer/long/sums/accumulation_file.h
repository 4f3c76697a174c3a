// Files of sums: checkpoints and shards of stills.
//
// Little-endian: the eight characters "LIMPIDAC"; format version (uint32: 2); length of the header (uint32);
// the header, JSON (renderer/long/sums/accumulation_header.h); rays, rejected samples, clamped means (uint64
// each); one bit per block, lowest first, whether it is in the sums, in whole bytes. If any block
// is: for each layer its sums (int128) by pixel and component; then, if the layers have "id" and block 0 is
// in the sums, instance and material of each pixel (uint32). Last the Hash64 of everything before (uint64).
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "renderer/long/sums/accumulation.h"
#include "renderer/long/sums/accumulation_header.h"

namespace limpid {

struct Accumulation {
    AccumulationHeader header;
    FrameSums sums;
};

/// Writes under a temporary name, flushes and renames, so an existing file stays complete until it is
/// replaced. Throws OutputError if the file cannot be written; Error if the sums do not match the header's
/// size, plan and layers, or contain part of a block.
void writeAccumulation(const std::filesystem::path& path, const AccumulationHeader& header,
                       const FrameSums& sums);

/// Throws InputError if the file is missing, of another kind, damaged or truncated. Allocates about as much
/// memory as the file is long.
Accumulation readAccumulation(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in messages.
Accumulation decodeAccumulation(std::span<const std::byte> bytes, const std::filesystem::path& name);

}  // namespace limpid
