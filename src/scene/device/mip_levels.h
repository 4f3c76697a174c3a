// Mip levels by a box filter in linear light, and texture look-up on the CPU (for light power).
#pragma once

#include <cstdint>
#include <vector>

#include "scene/model/scene.h"

namespace limpid::scene {

/// Levels down to 1x1: 1 + floor(log2(max(width, height))).
uint32_t mipLevelCount(const Texture& texture);

/// Of all levels together.
uint64_t mipTexelCount(const Texture& texture);

/// All levels, largest first, as packed RGBA8 (red in the lowest byte), sRGB-encoded where the texture is.
/// Level k is max(1, width >> k) by max(1, height >> k) texels.
std::vector<uint32_t> withMipLevels(const Texture& texture);
/// The same at the end of `result`.
void appendMipLevels(const Texture& texture, std::vector<uint32_t>& result);

/// The linear colour of the texel nearest to (u, v), wrapped as the sampler says.
vec4 nearestTexel(const Texture& texture, vec2 uv);

/// sRGB-encoded byte to linear.
float srgbToLinear(uint8_t encoded);

}  // namespace limpid::scene
