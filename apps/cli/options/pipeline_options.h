// The options --integrator and --denoiser, which several commands share.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "renderer/method/presets.h"

namespace limpid::cli {

/// --integrator, --denoiser, and --pipeline of former versions. The defaults are for the help text only.
void addPipelineOptions(CLI::App& command, PipelineChoice& choice, const std::string& defaultIntegrator,
                        const std::string& defaultDenoiser);

/// "none, temporal, ...", for help texts and messages.
std::string listOfDenoisers();

}  // namespace limpid::cli
