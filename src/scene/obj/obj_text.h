// Splits OBJ and MTL files into lines and words.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace limpid::scene {

/// Takes words from the front of a line.
class Words {
  public:
    explicit Words(std::string_view line) : rest_(line) {}

    std::string_view next();        ///< empty at the end of the line
    std::string_view peek() const;  ///< what next() would return
    std::string_view rest() const;  ///< the remainder, trimmed

  private:
    std::string_view rest_;
};

/// Reads a text line by line: removes comments, and joins lines that end in a backslash with the next.
class Lines {
  public:
    /// Throws InputError if the text is UTF-16 or contains a NUL character. Skips a UTF-8 byte order mark.
    Lines(std::filesystem::path file, std::span<const std::byte> text);

    /// Returns the next line that is not blank; none at the end. Valid until the next call.
    std::optional<std::string_view> next();

    /// Throws InputError: "file: line 12: fault".
    [[noreturn]] void fail(const std::string& fault) const;
    /// Parses a finite number. Throws InputError if the word is not one.
    float number(std::string_view word) const;
    /// Parses a number; returns nothing if the word is not one. Throws InputError if it is not finite.
    std::optional<float> tryNumber(std::string_view word) const;

    const std::filesystem::path& file() const { return file_; }
    size_t line() const { return line_; }
    size_t readBytes() const { return size_ - rest_.size(); }

  private:
    std::string_view takeLine();

    std::filesystem::path file_;
    size_t size_;
    std::string_view rest_;
    std::string joined_;  ///< the result of joining continued lines
    size_t line_ = 0;
};

}  // namespace limpid::scene
