#include "base/error.h"

#include "base/text/terminal_text.h"

namespace limpid {

UsageError::UsageError(const std::string& message) : Error(terminalText(message), ExitCode::Usage) {}

InputError::InputError(const std::filesystem::path& file, const std::string& fault)
    : Error(terminalText(file.string()) + ": " + fault, ExitCode::BadInput) {}

OutputError::OutputError(const std::filesystem::path& file, const std::string& fault)
    : Error(terminalText(file.string()) + ": " + fault, ExitCode::Failed) {}

}  // namespace limpid
