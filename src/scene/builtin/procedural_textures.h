// Generates textures for the built-in scenes: the same texels on every run. Colours are sRGB-encoded, 0 to 1.
// All tile seamlessly except the wood, which is mirrored at its edges, and the test picture, which does not
// tile.
#pragma once

#include <cstdint>

#include "scene/model/scene.h"

namespace limpid::scene {

/// A board of `squares` by `squares` squares; must be even.
Texture checkerTexture(uint32_t squares, const vec3& first, const vec3& second);

/// Four bricks by eight courses in running bond.
Texture brickTexture();
/// Normal map of the same bricks; mortar lies deeper.
Texture brickNormalTexture();

/// Noise of five octaves between two colours; the coarsest octave has `cells` by `cells` cells.
Texture noiseTexture(uint32_t cells, const vec3& dark, const vec3& bright);

/// A board cut along the grain near the centre of the trunk: elongated, wavy rings.
Texture woodTexture();

/// Normal map of round dents, like hammered metal.
Texture hammeredNormalTexture();

/// For a metal (blue) whose roughness (green) varies from `smooth` to `rough` in patches and along scratches.
Texture wornRoughnessTexture(float smooth, float rough);

/// 1,024 x 768: coarse and fine checkers, lines of characters like print, smooth colours, and rings that get
/// finer outwards. It makes the blur of denoisers visible.
Texture testPictureTexture();

}  // namespace limpid::scene
