// Lines and words of OBJ and MTL files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace limpid::scene {

/// Takes words off the front of one line.
class Words {
  public:
    explicit Words(std::string_view line) : rest_(line) {}

    std::string_view next();        ///< empty at the end of the line
    std::string_view peek() const;  ///< what next() would return
    std::string_view rest() const;  ///< all that is left, without blanks around it

  private:
    std::string_view rest_;
};

/// Goes through a text line by line: comments are cut off, a backslash at a line's end continues it.
class Lines {
  public:
    /// Throws InputError if the text is UTF-16 or holds a NUL character. A byte order mark of UTF-8 is
    /// skipped.
    Lines(std::filesystem::path file, std::span<const std::byte> text);

    /// The next line that is not blank; nothing at the end. Valid until the next call.
    std::optional<std::string_view> next();

    /// Throws InputError: "file: line 12: fault".
    [[noreturn]] void fail(const std::string& fault) const;
    /// A word as a finite number. Throws InputError if it is none.
    float number(std::string_view word) const;
    /// The number, or nothing if the word is none. Throws InputError if it is not finite.
    std::optional<float> tryNumber(std::string_view word) const;

    const std::filesystem::path& file() const { return file_; }
    size_t line() const { return line_; }

  private:
    std::string_view takeLine();

    std::filesystem::path file_;
    std::string_view rest_;
    std::string joined_;  ///< a line made of continued ones
    size_t line_ = 0;
};

}  // namespace limpid::scene
