#include "renderer/frame/reset_rule.h"

namespace limpid {

bool sameCamera(const CameraParams& a, const CameraParams& b) {
    return a.origin == b.origin && a.orthographic == b.orthographic && a.forward == b.forward &&
           a.spread == b.spread && a.right == b.right && a.up == b.up && a.lensRadius == b.lensRadius &&
           a.focusDistance == b.focusDistance;
}

bool mustReset(const AccumulationState& before, const AccumulationState& now) {
    RenderSettings settings = now.settings;
    settings.samplesPerLaunch = before.settings.samplesPerLaunch;
    settings.denoisers = before.settings.denoisers;
    settings.networks = before.settings.networks;
    return !sameCamera(before.camera, now.camera) || before.settings != settings ||
           before.sceneVersion != now.sceneVersion;
}

}  // namespace limpid
