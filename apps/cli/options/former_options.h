// Options of former versions: using one ends with exit code 2 and says what to write instead.
#pragma once

#include <CLI/CLI.hpp>

namespace limpid::cli {

/// --pipeline, which is --integrator and --denoiser now.
void refusePipelineOption(CLI::App& command);
/// --method, which is --denoiser now.
void refuseMethodOption(CLI::App& command);

}  // namespace limpid::cli
