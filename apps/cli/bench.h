// What the subcommands of `limpid bench` share.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "device_options.h"
#include "render_report.h"
#include "scene_options.h"

namespace limpid::cli {

double median(std::vector<double> values);

/// What files of a scene are named after: its name without path and prefix.
std::string sceneStem(const std::string& scene);

void addDenoiseBench(CLI::App& bench);
void addQualityBench(CLI::App& bench);

}  // namespace limpid::cli
