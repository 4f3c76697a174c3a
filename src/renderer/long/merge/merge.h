// Merges the shards of a still.
#pragma once

#include <filesystem>
#include <span>

#include "renderer/long/sums/accumulation_file.h"

namespace limpid {

/// Adds the sums of all files, with at most two of them in memory. Throws InputError with the file and the
/// reason if a file cannot be read, belongs to another render than the first or to a sequence, or contains a
/// block of an earlier file. Also throws if blocks are missing, naming them and their shards. Warns if files
/// come from different devices.
Accumulation mergeAccumulations(std::span<const std::filesystem::path> files);

}  // namespace limpid
