// Error handling: exceptions inside the library, exit codes at the program's edge (apps/cli/main.cpp).
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace limpid {

/// Process exit codes, in the order of docs/architecture.md.
enum class ExitCode { Done = 0, Failed = 1, Usage = 2, BadInput = 3 };

/// Base of every exception that Limpid throws on purpose; what() is a sentence for the user.
class Error : public std::runtime_error {
  public:
    // Inline, so that build tools can throw it without linking limpid::base.
    explicit Error(const std::string& message, ExitCode code = ExitCode::Failed)
        : std::runtime_error(message), code_(code) {}
    ExitCode code() const { return code_; }

  private:
    ExitCode code_;
};

/// The command line or a parameter is invalid. Exit code 2; the message is one line.
class UsageError : public Error {
  public:
    explicit UsageError(const std::string& message);
};

/// An input file could not be read. Exit code 3; the message is "file: fault", with the file's name escaped
/// for a terminal (base/text/terminal_text.h).
class InputError : public Error {
  public:
    InputError(const std::filesystem::path& file, const std::string& fault);
};

/// An output could not be written. Exit code 1; the message is "file: fault".
class OutputError : public Error {
  public:
    OutputError(const std::filesystem::path& file, const std::string& fault);
};

}  // namespace limpid
