// What a hand does to the camera: sums of movements, whatever the device they come from.
#pragma once

#include "studio/camera/fly_camera.h"

namespace limpid::studio {

struct Gesture {
    vec2 orbit{0.0f};    ///< radians, to the right and upwards
    vec2 look{0.0f};     ///< radians, to the right and upwards
    vec2 pan{0.0f};      ///< heights of the picture, to the right and upwards
    vec3 fly{0.0f};      ///< seconds at full speed, to the right, upwards and forwards
    float zoom = 0.0f;   ///< steps towards the target
    float speed = 0.0f;  ///< steps by which flying becomes faster

    bool moves() const {
        return orbit != vec2(0.0f) || look != vec2(0.0f) || pan != vec2(0.0f) || fly != vec3(0.0f) ||
               zoom != 0.0f || speed != 0.0f;
    }
    Gesture& operator+=(const Gesture& other);
    /// `unitsPerSecond` is the speed of flying, which the gesture may change.
    void apply(FlyCamera& camera, float& unitsPerSecond) const;
};

}  // namespace limpid::studio
