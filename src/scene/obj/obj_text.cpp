#include "scene/obj/obj_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "base/error.h"

namespace limpid::scene {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";

std::string_view trim(std::string_view text) {
    const size_t begin = text.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

}  // namespace

std::string_view Words::peek() const {
    const std::string_view text = rest();
    return text.substr(0, text.find_first_of(blanks));
}

std::string_view Words::next() {
    const std::string_view word = peek();
    rest_ = rest();
    rest_.remove_prefix(word.size());
    return word;
}

std::string_view Words::rest() const {
    return trim(rest_);
}

Lines::Lines(std::filesystem::path file, std::span<const std::byte> text)
    : file_(std::move(file)),
      size_(text.size()),
      rest_(reinterpret_cast<const char*>(text.data()), text.size()) {
    if (rest_.starts_with("\xff\xfe") || rest_.starts_with("\xfe\xff"))
        throw InputError(file_, "is UTF-16 text, which is not read: save it as UTF-8");
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
    const size_t null = rest_.find('\0');
    if (null == std::string_view::npos) return;
    const auto line = std::ranges::count(rest_.substr(0, null), '\n') + 1;
    throw InputError(file_,
                     fmt::format("line {}: holds a NUL character: this is no text, or it is UTF-16", line));
}

std::string_view Lines::takeLine() {
    const size_t end = rest_.find('\n');
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    return trim(line.substr(0, line.find('#')));
}

std::optional<std::string_view> Lines::next() {
    while (!rest_.empty()) {
        std::string_view line = takeLine();
        if (line.ends_with('\\')) {
            joined_.clear();
            while (line.ends_with('\\')) {
                joined_.append(line.substr(0, line.size() - 1)).append(" ");
                line = rest_.empty() ? std::string_view() : takeLine();
            }
            joined_.append(line);
            line = trim(joined_);
        }
        if (!line.empty()) return line;
    }
    return std::nullopt;
}

void Lines::fail(const std::string& fault) const {
    throw InputError(file_, fmt::format("line {}: {}", line_, fault));
}

std::optional<float> Lines::tryNumber(std::string_view word) const {
    std::string_view digits = word;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (digits.empty() || end != digits.data() + digits.size() || error == std::errc::invalid_argument) {
        return std::nullopt;
    }
    // Outside a double's range: too small becomes zero; too large is rejected like infinity and NaN.
    if (error == std::errc::result_out_of_range && word.find("e-") != std::string_view::npos) return 0.0f;
    if (error != std::errc() || !(std::abs(value) < 3.4e38)) {
        fail(fmt::format("'{}' is not a finite number", word.substr(0, 40)));
    }
    return static_cast<float>(value);
}

float Lines::number(std::string_view word) const {
    if (word.empty()) fail("a number is missing");
    const auto value = tryNumber(word);
    if (!value) fail(fmt::format("'{}' is not a number", word.substr(0, 40)));
    return *value;
}

}  // namespace limpid::scene
