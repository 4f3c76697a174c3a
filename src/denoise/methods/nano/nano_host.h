// What computes a network behind SVGF on the CPU, instead of shaders: for devices that are the CPU, where
// that is many times as fast. src/denoise/nano_host makes one.
#pragma once

#include <cstdint>
#include <span>

#include "denoise/methods/nano/nano_tiles.h"

namespace limpid::denoise {

class NanoHost {
  public:
    virtual ~NanoHost() = default;

    /// Computes a tile's convolutions, from the second one on, and the filter; from several threads one after
    /// another. `channels` are halves, those of the first convolution. `light`: LightPair of
    /// nano_storage.glsl, eight halves. Both have a pixel's values side by side. `result`: eight floats for
    /// each pixel of the inner part, in rows of extent.width pixels: diffuse light, the share of it that
    /// replaces SVGF's, and the same of specular light. Throws Error if a span is too small.
    virtual void run(const NanoNetwork& network, const NanoTile& tile, std::span<const uint16_t> channels,
                     std::span<const uint16_t> light, std::span<float> result) = 0;
};

}  // namespace limpid::denoise
