// The subcommands. Each adds itself to the program; its callback runs it and throws limpid::Error on failure.
#pragma once

#include <CLI/CLI.hpp>

namespace limpid::cli {

void addRenderCommand(CLI::App& app);
void addMergeCommand(CLI::App& app);
void addDenoiseCommand(CLI::App& app);
void addCompareCommand(CLI::App& app);
void addDatasetCommand(CLI::App& app);
void addBenchCommand(CLI::App& app);
void addServeCommand(CLI::App& app);
void addViewCommand(CLI::App& app);
void addInfoCommand(CLI::App& app);
/// Hidden: what the installation and packages are made with. Last, since it lists the others.
void addManualCommands(CLI::App& app);

}  // namespace limpid::cli
