// The secret in the address of the page.
#pragma once

#include <string>
#include <string_view>

namespace limpid::serve {

/// 128 random bits of the operating system, as 32 hexadecimal digits. Throws Error if it has none.
std::string makeToken();

/// Whether two tokens are equal; the time does not tell where they differ.
bool sameToken(std::string_view a, std::string_view b);

}  // namespace limpid::serve
