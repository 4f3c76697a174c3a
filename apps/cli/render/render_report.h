// What `limpid render` says at its end: a line, or a JSON object.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/console/pass_times.h"
#include "cli/options/render_options.h"
#include "denoise/methods/temporal/temporal.h"
#include "gpu/vulkan/device.h"
#include "renderer/long/sums/accumulation.h"
#include "scene/device/gpu_scene.h"
#include "scene/model/scene.h"

namespace limpid::cli {

struct Timings {
    double loadSeconds = 0.0, renderSeconds = 0.0;
    double uploadSeconds = 0.0;  ///< with the time to open the device
};

struct RenderSummary {
    int frames = 0;
    uint64_t framesFinished = 0;  ///< with those of earlier runs
    uint64_t framesToDo = 0;      ///< of the shard
    uint64_t blocksFinished = 0;
    uint64_t samples = 0;  ///< of the last picture or file of sums, per pixel
    bool complete = false;
    bool lostState = false;                 ///< the checkpoint could not be written at the end
    SampleCounts counts;                    ///< of this run
    std::vector<uint64_t> piecesByProcess;  ///< of several that share the work: blocks of a still, or frames
    Timings timings;
    std::map<std::string, double> lastFrame;                  ///< milliseconds by pass, of the last launch
    std::map<std::string, double> medians;                    ///< ... over all frames; empty with `path`
    std::optional<denoise::DisocclusionCounts> disocclusion;  ///< of the last frame
};

/// Warns of what was lost and of what is still to be done, then reports.
void reportRender(const RenderOptions& options, const gpu::Device& device, const RenderSummary& summary,
                  const scene::Scene& scene, const scene::GpuScene& gpuScene);

}  // namespace limpid::cli
