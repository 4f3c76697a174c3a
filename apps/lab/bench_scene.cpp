#include "lab/bench_scene.h"

#include <utility>

#include "cli/console/pass_times.h"
#include "cli/options/sequence_options.h"
#include "renderer/frame/frame_renderer.h"
#include "renderer/sequence/sequence.h"

namespace limpid::cli {

BenchScene::BenchScene(gpu::Device& device, scene::Tracer tracer, const scene::SceneSource& source,
                       std::string cameraPath)
    : device_(device),
      cameraPath_(std::move(cameraPath)),
      scene_(scene::openScene(source)),
      data_(scene::buildSceneData(scene_)),
      gpuScene_(device, data_, {tracer, {}}) {}

std::map<std::string, PassCost> BenchScene::measure(const RenderSettings& settings, uint32_t warmup,
                                                    uint32_t frames, std::optional<gpu::Backing> filters) {
    const uint64_t count = uint64_t{warmup} + frames;
    const scene::Camera& camera = scene_.cameras.front();
    SequenceChoice choice;
    choice.cameraPath = cameraPath_;
    choice.frames = static_cast<int>(count);
    const Sequence sequence(scene_, data_, camera, chosenPath(choice, scene_, camera), choice.timing);
    FrameRenderer renderer(device_, gpuScene_, settings, 1);
    if (filters) renderer.setFilterBacking(*filters);
    std::map<std::string, PassCost> costs;
    for (uint64_t frame = 0; frame < count; ++frame) {
        renderer.render(sequence.moment(frame, settings.extent));
        const std::vector<gpu::PassTime> times = renderer.passTimes();
        if (frame < warmup) continue;
        for (const auto& [name, milliseconds] : sumByName(times))
            costs[name].milliseconds.push_back(milliseconds);
    }
    for (const gpu::RecordedPass& pass : renderer.graph().passes()) costs[pass.name].bytes += pass.imageBytes;
    return costs;
}

}  // namespace limpid::cli
