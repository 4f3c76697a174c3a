#include "base/text/terminal_text.h"

#include <cstddef>
#include <cstdint>

namespace limpid {
namespace {

uint8_t byteAt(std::string_view text, size_t i) {
    return static_cast<uint8_t>(text[i]);
}

/// Returns the length of the UTF-8 character at the start of `text`, or 0 if it is invalid (RFC 3629).
size_t characterLength(std::string_view text) {
    const uint8_t first = byteAt(text, 0);
    if (first < 0x80) return 1;
    const size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4 || text.size() < length) return 0;
    for (size_t i = 1; i < length; ++i) {
        if ((byteAt(text, i) & 0xC0) != 0x80) return 0;
    }
    const uint8_t second = byteAt(text, 1);
    const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
    const bool surrogate = first == 0xED && second > 0x9F;
    const bool beyond = first == 0xF4 && second > 0x8F;
    return overlong || surrogate || beyond ? 0 : length;
}

bool isControl(std::string_view character) {
    const uint8_t first = byteAt(character, 0);
    return first < 0x20 || first == 0x7F || (first == 0xC2 && byteAt(character, 1) < 0xA0);
}

}  // namespace

std::string terminalText(std::string_view text, LineBreaks breaks) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const size_t length = characterLength(text);
        const std::string_view taken = text.substr(0, length == 0 ? 1 : length);
        text.remove_prefix(taken.size());
        const bool kept = breaks == LineBreaks::Keep && (taken == "\n" || taken == "\t");
        if (kept || (length > 0 && !isControl(taken))) {
            result += taken;
            continue;
        }
        constexpr std::string_view digits = "0123456789abcdef";
        for (size_t i = 0; i < taken.size(); ++i)
            result.append("\\x").append({digits[byteAt(taken, i) >> 4], digits[byteAt(taken, i) & 15]});
    }
    return result;
}

}  // namespace limpid
