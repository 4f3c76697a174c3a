#include "renderer/frame/sequence.h"

namespace limpid {

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

Moment Sequence::moment(uint64_t frame, gpu::Extent extent) const {
    const double now = timing_.timeOf(frame);
    const double before = frame == 0 ? now : timing_.timeOf(frame - 1);
    Moment moment;
    moment.number = frame;
    moment.camera = cameraAt(now, extent);
    const bool cut = frame == 0 || (path_ && path_->cutBetween(before, now));
    if (!cut) moment.previousCamera = cameraAt(before, extent);
    if (animator_) moment.scene = animator_->frame(now, cut ? now : before);
    return moment;
}

}  // namespace limpid
