// Formats amounts of memory.
#pragma once

#include <cstdint>
#include <string>

namespace limpid {

/// Returns text such as "12.5 MiB", in the largest unit up to GiB of which there is at least one.
std::string bytesText(uint64_t bytes);

}  // namespace limpid
