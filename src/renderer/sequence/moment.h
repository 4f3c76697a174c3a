// A point in time of a scene, which one frame shows.
#pragma once

#include <cstdint>
#include <optional>

#include "scene/motion/scene_animator.h"
#include "shaders/common/camera.h"

namespace limpid {

struct Moment {
    CameraParams camera;
    std::optional<CameraParams> previousCamera;  ///< empty: the first frame, or a cut; all motion is invalid
    std::optional<scene::SceneFrame> scene;      ///< empty: nothing moves but the camera
    uint64_t number = 0;                         ///< of the frame; selects the random numbers
};

}  // namespace limpid
