// Pictures by code for the built-in scenes: the same texels on every run. Colours are sRGB-encoded, 0 to 1.
// All repeat without a seam except the wood, which is mirrored at its edges, and the test picture, which ends
// there.
#pragma once

#include <cstdint>

#include "scene/model/scene.h"

namespace limpid::scene {

/// `squares` by `squares` squares; an even number.
Texture checkerTexture(uint32_t squares, const vec3& first, const vec3& second);

/// Four bricks by eight courses, running bond.
Texture brickTexture();
/// Normal map of the same bricks: mortar lies deeper.
Texture brickNormalTexture();

/// Noise of five octaves between two colours; the coarsest has `cells` by `cells`.
Texture noiseTexture(uint32_t cells, const vec3& dark, const vec3& bright);

/// A board cut along the grain near the heart: elongated, wavy rings.
Texture woodTexture();

/// Normal map of round dents, as a hammer leaves them.
Texture hammeredNormalTexture();

/// Of a metal (blue) whose roughness (green) goes from `smooth` to `rough` in patches and along scratches.
Texture wornRoughnessTexture(float smooth, float rough);

/// 1,024 x 768: checkers coarse and fine, lines of signs like print, smooth colours, rings that get finer
/// outwards. What denoisers blur shows in it.
Texture testPictureTexture();

}  // namespace limpid::scene
