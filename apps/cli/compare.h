// limpid compare TEST REFERENCE
#pragma once

namespace CLI {
class App;
}

namespace limpid::cli {

/// Adds the subcommand `compare` to `app`; parsing it runs it. It prints its result on stdout and throws
/// limpid::Error.
void addCompareCommand(CLI::App& app);

}  // namespace limpid::cli
