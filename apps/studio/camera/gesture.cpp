#include "studio/camera/gesture.h"

#include <cmath>

namespace limpid::studio {
namespace {

constexpr float zoomPerStep = 0.85f;

}  // namespace

Gesture& Gesture::operator+=(const Gesture& other) {
    orbit += other.orbit;
    look += other.look;
    pan += other.pan;
    fly += other.fly;
    zoom += other.zoom;
    speed += other.speed;
    return *this;
}

void Gesture::apply(FlyCamera& camera, float& unitsPerSecond) const {
    if (orbit != vec2(0.0f)) camera.orbit(orbit.x, orbit.y);
    if (pan != vec2(0.0f)) camera.pan(pan.x, pan.y);
    if (zoom != 0.0f) camera.zoom(std::pow(zoomPerStep, zoom));
    if (look != vec2(0.0f)) camera.look(look.x, look.y);
    unitsPerSecond *= std::pow(1.0f / zoomPerStep, speed);
    if (fly != vec3(0.0f)) camera.move(unitsPerSecond * fly);
}

}  // namespace limpid::studio
