#include "studio/live/stage.h"

#include <utility>

namespace limpid::studio {

Stage::Stage(gpu::Device& device, LoadedScene loaded, scene::Tracer tracer)
    : scene_(std::move(loaded.scene)),
      originalLights_(scene::lightControlsOf(scene_)),
      lights_(originalLights_),
      sphere_(scene::boundingSphere(scene_)) {
    const scene::SceneData& data = loaded.data;
    onDevice_.emplace(device, data, scene::TraceOptions{tracer, {}});
    live_.emplace(scene_, data);
    if (scene_.clip != scene::none) animator_.emplace(scene_, data);
}

void Stage::setLights(const std::vector<scene::LightControl>& lights) {
    if (lights == lights_ || lights.size() != lights_.size()) return;
    scene::applyLightControls(scene_, lights, lights_);
    lights_ = lights;
    live_->update(scene_);
    if (animator_) animator_->setLights(live_->packed());
    lightsChanged_ = true;
}

std::optional<scene::SceneFrame> Stage::nextFrame(const std::optional<Step>& step, double time) {
    const bool moves = animator_ && step;
    lightsSent_ = std::exchange(lightsChanged_, false);
    if (!moves && !lightsSent_) return std::nullopt;
    scene::SceneFrame frame = frameOf(step.value_or(Step{time, time}));
    if (lightsSent_) live_->addTo(frame);
    return frame;
}

std::optional<scene::SceneFrame> Stage::standAt(double time) const {
    if (!animator_) return std::nullopt;
    return frameOf({time, time});
}

scene::SceneFrame Stage::frameOf(const Step& step) const {
    scene::SceneFrame frame;
    if (animator_)
        frame = animator_->frame(step.to, step.from);
    else
        frame.params = onDevice_->params();
    live_->setParams(frame.params);
    return frame;
}

double Stage::duration() const {
    return scene_.clip == scene::none ? 0.0
                                      : double{scene_.rig.clips[static_cast<size_t>(scene_.clip)].duration()};
}

}  // namespace limpid::studio
