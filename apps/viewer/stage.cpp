#include "stage.h"

namespace limpid::viewer {

Stage::Stage(gpu::Device& device, scene::Scene scene, scene::Tracer tracer)
    : scene_(std::move(scene)), sphere_(scene::boundingSphere(scene_)) {
    const scene::SceneData data = scene::buildSceneData(scene_);
    onDevice_.emplace(device, data, scene::TraceOptions{tracer, {}});
    if (scene_.clip != scene::none) animator_.emplace(scene_, data);
}

double Stage::duration() const {
    return scene_.clip == scene::none ? 0.0
                                      : double{scene_.rig.clips[static_cast<size_t>(scene_.clip)].duration()};
}

}  // namespace limpid::viewer
