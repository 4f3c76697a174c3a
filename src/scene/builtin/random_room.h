// Rooms drawn from a number: as many different scenes as wanted, to train networks on (docs/kpcn.md) and to
// try things.
#pragma once

#include <cstdint>

#include "scene/model/scene.h"

namespace limpid::scene {

/// A room of 3 to 9 m with up to 30 things in it, lit by lamps, through a window, or without a ceiling from
/// the sky; diffuse, glossy, metallic, mirroring and glass surfaces, some textured. Fronts of the walls look
/// inside. The camera stands in the room and in nothing. The same scene for the same seed, everywhere. None
/// of the textures of the laboratory's scenes is used with their colours, and their test picture not at all.
Scene randomRoom(uint32_t seed);

}  // namespace limpid::scene
