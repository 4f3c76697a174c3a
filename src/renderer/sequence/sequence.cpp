#include "renderer/sequence/sequence.h"

#include <algorithm>

namespace limpid {

double offsetDuring(const SequenceTiming& timing, const std::optional<scene::CameraPath>& path, double time,
                    double instant) {
    const auto isOtherShot = [&](double other) {
        return path && path->cutBetween(std::min(time, other), std::max(time, other));
    };
    double offset = timing.shutter.offset(instant) / timing.framesPerSecond;
    if (isOtherShot(time + offset)) offset = -offset;
    if (isOtherShot(time + offset)) offset = 0.0;
    return offset;
}

Sequence::Sequence(const scene::Scene& scene, const scene::SceneData& data, scene::Camera camera,
                   std::optional<scene::CameraPath> path, const SequenceTiming& timing,
                   const scene::Lens& lens)
    : scene_(scene), camera_(std::move(camera)), path_(std::move(path)), timing_(timing), lens_(lens) {
    if (scene.clip != scene::none) animator_.emplace(scene, data);
}

CameraParams Sequence::cameraAt(double time, gpu::Extent extent) const {
    const scene::Camera camera = path_ ? path_->at(time) : scene::cameraAt(scene_, camera_, time);
    return scene::cameraParams(scene::withLens(camera, lens_), extent.width, extent.height);
}

Moment Sequence::momentAt(uint64_t frame, double offset, gpu::Extent extent) const {
    const double now = timing_.timeOf(frame) + offset;
    std::optional<double> before;
    if (frame > 0) before = timing_.timeOf(frame - 1) + offset;
    if (before && isCut(*before, now)) before.reset();
    Moment moment;
    moment.number = frame;
    moment.camera = cameraAt(now, extent);
    if (before) moment.previousCamera = cameraAt(*before, extent);
    if (animator_) moment.scene = animator_->frame(now, before.value_or(now));
    return moment;
}

Moment Sequence::moment(uint64_t frame, gpu::Extent extent) const {
    return momentAt(frame, 0.0, extent);
}

Moment Sequence::momentDuring(uint64_t frame, double instant, gpu::Extent extent) const {
    return momentAt(frame, offsetDuring(timing_, path_, timing_.timeOf(frame), instant), extent);
}

}  // namespace limpid
