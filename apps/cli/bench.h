// What the subcommands of `limpid bench` share.
#pragma once

#include <CLI/CLI.hpp>
#include <vector>

#include "device_options.h"
#include "render_report.h"
#include "scene_options.h"

namespace limpid::cli {

double median(std::vector<double> values);

void addDenoiseBench(CLI::App& bench);

}  // namespace limpid::cli
