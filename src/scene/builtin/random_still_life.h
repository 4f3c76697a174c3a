// Generates a still life from a random seed, with features that rooms (scene/builtin/random_room.h) lack.
#pragma once

#include <cstdint>

#include "scene/model/scene.h"

namespace limpid::scene {

/// Returns up to 14 objects within about a metre, outdoors under a sky, a studio's lights or the night, on a
/// ground, on a pedestal or floating; also glowing signs, shaded lamps with a point light close to the shade,
/// boards with detailed pictures, bumps and worn metal. The camera stands outside, near or far. The same seed
/// gives the same scene everywhere. Textures of the denoiser lab's scenes only appear in other colours, and
/// the test picture never appears.
Scene randomStillLife(uint32_t seed);

}  // namespace limpid::scene
