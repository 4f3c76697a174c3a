// Recognises files by their first bytes, for messages about files of the wrong kind.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace limpid {

/// Describes how a file of the wrong kind begins: "it begins with 89 50 4e 47, as a PNG picture does", "it is
/// empty".
std::string describeBeginning(std::span<const std::byte> bytes);

}  // namespace limpid
