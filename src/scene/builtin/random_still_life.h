// Still lifes drawn from a number: what rooms (scene/builtin/random_room.h) do not have.
#pragma once

#include <cstdint>

#include "scene/model/scene.h"

namespace limpid::scene {

/// Up to 14 things within a metre or so, in the open before a sky, a studio's lights or the night, on a
/// ground, on a pedestal or on nothing; also signs that glow, shaded lamps with a point light close to the
/// shade, boards with fine pictures, bumps and worn metal. The camera stands outside, near or far. The same
/// scene for the same seed, everywhere. None of the textures of the laboratory's scenes is used with their
/// colours, and their test picture not at all.
Scene randomStillLife(uint32_t seed);

}  // namespace limpid::scene
