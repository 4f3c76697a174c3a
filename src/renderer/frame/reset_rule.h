// When a running mean must restart.
#pragma once

#include <cstdint>

#include "renderer/method/settings.h"
#include "shaders/common/camera.h"

namespace limpid {

/// Everything an accumulated image depends on.
struct AccumulationState {
    CameraParams camera{};
    RenderSettings settings;
    uint64_t sceneVersion = 0;  ///< incremented by whoever changes the scene
};

bool sameCamera(const CameraParams& a, const CameraParams& b);

/// True if samples taken under `before` must not be averaged with samples under `now`: the camera's matrix or
/// field of view, the size, any setting, or the scene has changed. (Samples per launch do not
/// change the distribution of a pixel, and the output of denoisers is not accumulated.)
bool mustReset(const AccumulationState& before, const AccumulationState& now);

}  // namespace limpid
