// The options of `limpid render`, and what they come to.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/options/device_options.h"
#include "cli/options/lens_options.h"
#include "cli/options/long_render_options.h"
#include "cli/options/pipeline_options.h"
#include "cli/options/scene_options.h"
#include "cli/options/sequence_options.h"
#include "renderer/method/settings.h"

namespace limpid::cli {

struct RenderOptions {
    SceneChoice scene;
    scene::Lens lens;
    SequenceChoice sequence;
    DeviceChoice device;
    LongRenderChoice longRender;
    std::string output;
    uint32_t width = 1280, height = 720;
    uint64_t samples = 0;  // 0: the pipeline's own default
    uint32_t samplesPerLaunch = 1;
    uint32_t seed = 0;
    int maxDepth = -1;  // -1: the parameter's own default
    PipelineChoice pipeline;
    std::string sampler, jitter, exposure = "auto", toneCurve = "standard", layers, dump,
                                 weights;  ///< "": as the preset says
    std::string preset;
    std::vector<std::string> assignments;
    bool progressive = false, preview = false, floatExr = false, json = false;
};

void addRenderOptions(CLI::App& command, RenderOptions& options);

/// `name`: pixel, frame or off.
Jitter parseJitter(const std::string& name);

/// Throws UsageError or OutputError if the options contradict each other, or name what there is not.
void checkRenderOptions(const RenderOptions& options);

/// Throws UsageError if one of so many frames of the output would replace a file that the scene was loaded
/// from.
void checkSceneIsNoOutput(const RenderOptions& options, const scene::Scene& scene, int frames);

/// That of --integrator and --denoiser, else of --preset, else the path tracer alone.
Pipeline pipelineOf(const RenderOptions& options);
/// Each is made of its own samples and nothing else, in any order and by any process.
bool hasIndependentFrames(const Pipeline& pipeline);
/// Asked for, or by a preset where nothing speaks against it.
bool isProgressive(const RenderOptions& options);
RenderSettings settingsOf(const RenderOptions& options);
/// Per pixel; of a frame, where the pipeline goes from frame to frame.
uint64_t samplesOf(const RenderOptions& options);
/// In the order of layerNames(), each once.
std::vector<std::string> chosenLayers(const RenderOptions& options);
/// A shard of a still is no picture yet.
bool writesSums(const RenderOptions& options);

}  // namespace limpid::cli
