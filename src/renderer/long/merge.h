// Shards of a still put together.
#pragma once

#include <filesystem>
#include <span>

#include "renderer/long/accumulation_file.h"

namespace limpid {

/// Reads the files and adds them up; holds two of them at a time. Throws InputError naming the file and the
/// reason if one cannot be read, is of another render than the first, is of a sequence, or has a block that
/// an earlier one has; and if all together lack blocks, naming those and the shards they belong to. Warns
/// where files come from different devices.
Accumulation mergeAccumulations(std::span<const std::filesystem::path> files);

}  // namespace limpid
