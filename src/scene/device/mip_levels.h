// Makes mip levels with a box filter in linear light, and looks up textures on the CPU (for light power).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/model/scene.h"

namespace limpid::scene {

/// Returns the number of levels down to 1x1: 1 + floor(log2(max(width, height))).
uint32_t mipLevelCount(const Texture& texture);

/// Returns the number of texels of all levels.
uint64_t mipTexelCount(const Texture& texture);

/// Returns all levels, largest first, as packed RGBA8 (red in the lowest byte), sRGB-encoded if the texture
/// is. Level k has max(1, width >> k) by max(1, height >> k) texels.
std::vector<uint32_t> withMipLevels(const Texture& texture);
/// Like withMipLevels(), but writes to `result`, which has mipTexelCount() texels.
void writeMipLevels(const Texture& texture, std::span<uint32_t> result);

/// Returns the linear colour of the texel nearest to (u, v), wrapped according to the sampler.
vec4 nearestTexel(const Texture& texture, vec2 uv);

/// Converts an sRGB-encoded byte to linear.
float srgbToLinear(uint8_t encoded);

}  // namespace limpid::scene
