// What C++ shares with lights_sample.comp, which draws lights at one point.
#pragma once

#include <cstdint>

#include "scene/device/gpu_scene.h"

namespace limpid::test {

struct DrawnLight {
    vec3 direction;
    float distance;
    vec3 radiance;
    float pdf;
    uint32_t delta;
    float hitDistance, hitPdf;
};

struct LightsSampleParams {
    layout::SceneParams scene;
    vec3 from, normal;
    uint32_t count, seed;
};

}  // namespace limpid::test
