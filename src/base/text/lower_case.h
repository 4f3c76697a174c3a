// Lower case for extensions, names of devices and searches.
#pragma once

#include <string>
#include <string_view>

namespace limpid {

/// ASCII only, whatever the locale; other bytes stay.
inline std::string lowerCase(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return lower;
}

}  // namespace limpid
