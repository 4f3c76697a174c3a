// Options of the commands that show a scene live: `limpid view` and `limpid serve`.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/options/device_options.h"
#include "cli/options/pipeline_options.h"
#include "cli/options/scene_options.h"
#include "studio/settings.h"

namespace limpid::cli {

struct StudioChoice {
    SceneChoice scene;
    DeviceChoice device;
    PipelineChoice pipeline;
    bool preview = false;
    std::optional<uint32_t> samples;
    std::optional<uint64_t> maxSamples;
    std::optional<int> shrink;  ///< 0 to 3; empty: automatic
    std::string animation, weights, shaders, preset, state;
    std::vector<std::string> assignments;
    uint32_t width = 1000, height = 720, seed = 0;
};

void addStudioOptions(CLI::App& command, StudioChoice& choice);

/// What the command line says, over `settings`. Throws UsageError.
void apply(const StudioChoice& choice, studio::StudioSettings& settings);

studio::TracerChoice tracerChoice(const StudioChoice& choice);
studio::SceneLoader sceneLoader();
studio::CameraStart cameraStart(const StudioChoice& choice);

}  // namespace limpid::cli
