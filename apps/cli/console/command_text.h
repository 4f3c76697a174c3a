// A command line as text, to be run again.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace limpid::cli {

/// The command's name and the options that were given, as a shell reads them.
std::string commandText(const CLI::App& command);

}  // namespace limpid::cli
