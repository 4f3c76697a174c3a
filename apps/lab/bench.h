// What the subcommands of `limpid bench` share.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/console/pass_times.h"
#include "cli/options/device_options.h"
#include "scene/load/scene_source.h"

namespace limpid::cli {

/// What files of a scene are named after: its name without path and prefix.
std::string sceneStem(const std::string& scene);

void addDenoiseBench(CLI::App& bench);
void addFilesBench(CLI::App& bench);
void addFirstFrameBench(CLI::App& bench);
void addKpcnBench(CLI::App& bench);
void addLaunchesBench(CLI::App& bench);
void addQualityBench(CLI::App& bench);
void addServeBench(CLI::App& bench);
void addSvgfBench(CLI::App& bench);

}  // namespace limpid::cli
