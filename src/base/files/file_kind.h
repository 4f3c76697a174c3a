// What a file's first bytes say about it: for messages about files of the wrong kind.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace limpid {

/// How a file that is not of the kind wanted begins: "it begins with 89 50 4e 47, as a PNG picture does", "it
/// is empty".
std::string describeBeginning(std::span<const std::byte> bytes);

}  // namespace limpid
