// Night for a random room or still life: dim light, but for a few lamps.
#pragma once

#include <cstdint>

#include "scene/model/scene.h"

namespace limpid::cli {

/// Dims all light to between a hundredth and a fifth, except for one or two lamps. Where there is no lamp,
/// one or two warm point lights are added.
void makeNight(scene::Scene& scene, uint32_t seed);

}  // namespace limpid::cli
