// How mouse and keys move the camera.
#pragma once

#include "viewer/camera/fly_camera.h"

namespace limpid::viewer {

/// What a hand does to the picture in one frame, as ImGui has it.
struct Steering {
    bool left = false, middle = false, right = false;  ///< buttons that are held
    float x = 0.0f, y = 0.0f;                          ///< the mouse's way, pixels to the right and down
    float height = 1.0f;                               ///< of the window, pixels
    float wheel = 0.0f;                                ///< steps away from the hand

    static Steering now();
    bool moves() const { return ((left || middle) && (x != 0.0f || y != 0.0f)) || right || wheel != 0.0f; }
    /// `speed`, of keys, in world units a second, is what the wheel changes while the right button is held.
    void apply(FlyCamera& camera, float seconds, float& speed) const;
};

}  // namespace limpid::viewer
