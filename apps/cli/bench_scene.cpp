#include "bench_scene.h"

#include "pass_times.h"
#include "renderer/frame_renderer.h"
#include "renderer/sequence.h"
#include "scene/camera_path.h"
#include "scene_options.h"

namespace limpid::cli {

BenchScene::BenchScene(gpu::Device& device, scene::Tracer tracer, const std::string& name)
    : device_(device),
      scene_(loadChosenScene({name, "", ""})),
      data_(scene::buildSceneData(scene_)),
      gpuScene_(device, data_, {tracer, {}}) {}

std::map<std::string, PassCost> BenchScene::measure(const RenderSettings& settings, uint32_t warmup,
                                                    uint32_t frames, std::optional<gpu::Backing> filters) {
    const SequenceTiming timing;
    const uint64_t count = uint64_t{warmup} + frames;
    const scene::Camera& camera = scene_.cameras.front();
    const Sequence sequence(scene_, data_, camera,
                            scene::builtinCameraPath("shake", scene_, camera, timing.timeOf(count)), timing);
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
