// What computes a network behind SVGF on the CPU, instead of shaders: for devices that are the CPU, where
// that is many times as fast. src/denoise/nano_host makes one.
#pragma once

#include <cstdint>
#include <span>

#include "denoise/methods/nano/nano_tiles.h"

namespace limpid::denoise {

class NanoHost {
  public:
    /// What a pixel of a tile takes, about: channels of all levels, and light, in single precision.
    static uint64_t bytesOfPixel(const NanoNetwork& network) {
        return uint64_t{16} * network.levels[0].halve.outputs * NANO_GROUP + 64;
    }
    /// Tiles should take no more.
    static constexpr uint64_t mostBytes = uint64_t{704} << 20;

    virtual ~NanoHost() = default;

    /// Computes a tile's convolutions, from the second one on, and the filter. Several threads may call it:
    /// they wait for each other. `network` is recognised by its address, and must live as long as the host.
    /// `channels` are halves, those of the first convolution. `light`: LightPair of nano_storage.glsl, eight
    /// halves. Both have a pixel's values side by side. `result`: eight floats for each pixel of the inner
    /// part, in rows of extent.width pixels: diffuse light, the share of it that replaces SVGF's, and the
    /// same of specular light. Throws Error if a span is too small.
    virtual void run(const NanoNetwork& network, const NanoTile& tile, std::span<const uint16_t> channels,
                     std::span<const uint16_t> light, std::span<float> result) = 0;
};

}  // namespace limpid::denoise
