// Generates a room from a random seed: an unlimited number of different scenes, for training networks
// (docs/kpcn.md) and for experiments.
#pragma once

#include <cstdint>

#include "scene/model/scene.h"

namespace limpid::scene {

/// Returns a room of 3 to 9 m with up to 30 objects, lit by lamps, through a window, or by the sky if it has
/// no ceiling; with diffuse, glossy, metallic, mirror and glass surfaces, some textured. The fronts of the
/// walls face inside. The camera stands in the room, outside of all objects. The same seed gives the same
/// scene everywhere. Textures of the denoiser lab's scenes only appear in other colours, and the test picture
/// never appears.
Scene randomRoom(uint32_t seed);

}  // namespace limpid::scene
