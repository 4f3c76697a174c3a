// A render that is set up: what its two ways of going through the frames share.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/options/render_options.h"
#include "cli/render/clip_output.h"
#include "cli/render/picture_output.h"
#include "cli/render/render_report.h"
#include "image/image.h"
#include "renderer/sequence/sequence.h"

namespace limpid::cli {

struct RenderJob {
    const RenderOptions& options;
    const RenderSettings& settings;
    gpu::Device& device;
    scene::GpuScene& scene;
    const Sequence& sequence;
    uint64_t sceneContent = 0;  ///< sceneHash()
    int frames = 1;
    std::chrono::steady_clock::time_point started;
    ClipWriter* clip = nullptr;  ///< where frames go, if the output is a clip
};

/// Writes a frame's picture to the output: a file of its own, or the clip's next frame.
void writeFrame(const RenderJob& job, uint64_t frame, const PictureFormat& format,
                const RenderedLayers& layers, const std::map<std::string, std::string>& metadata);

/// `path`: each frame is a mean of its own; block by block, so that it can be stopped, resumed and shared
/// out.
void renderIndependentFrames(const RenderJob& job, RenderSummary& summary);
/// All others: frames in order, each built on the one before.
void renderSuccessiveFrames(const RenderJob& job, RenderSummary& summary);

/// The images that --dump names, beside `output`.
void writeDump(const std::filesystem::path& output,
               const std::vector<std::pair<std::string, image::Image>>& images);

}  // namespace limpid::cli
