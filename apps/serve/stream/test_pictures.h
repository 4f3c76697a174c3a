// Synthetic pictures for tests of the server.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "studio/picture.h"

namespace limpid::serve {

/// Uniform noise.
inline studio::Picture noisePicture(gpu::Extent extent) {
    studio::Picture picture{extent, std::vector<uint32_t>(size_t{extent.width} * extent.height)};
    std::mt19937 random(7);
    for (uint32_t& texel : picture.texels) texel = static_cast<uint32_t>(random()) | 0xff000000u;
    return picture;
}

/// Smooth waves that move to the right with `time`.
inline studio::Picture wavePicture(gpu::Extent extent, double time) {
    studio::Picture picture{extent, {}};
    for (uint32_t y = 0; y < extent.height; ++y) {
        for (uint32_t x = 0; x < extent.width; ++x) {
            const auto wave = [&](double a, double b) {
                return static_cast<uint32_t>(
                    std::lround(128.0 + 100.0 * std::sin((x - 3.0 * time) * a + y * b)));
            };
            picture.texels.push_back(wave(0.05, 0.02) | wave(0.03, 0.06) << 8 | wave(0.02, -0.04) << 16 |
                                     0xff000000u);
        }
    }
    return picture;
}

/// Decibels over red, green and blue of 8 bits; 99 where they are equal.
inline double psnr(const studio::Picture& a, const studio::Picture& b) {
    double sum = 0.0;
    for (size_t i = 0; i < a.texels.size(); ++i) {
        for (int shift = 0; shift < 24; shift += 8) {
            const double difference = static_cast<int>(a.texels[i] >> shift & 0xff) -
                                      static_cast<int>(b.texels.at(i) >> shift & 0xff);
            sum += difference * difference;
        }
    }
    const double mean = sum / (3.0 * static_cast<double>(a.texels.size()));
    return mean > 0.0 ? std::min(99.0, 10.0 * std::log10(255.0 * 255.0 / mean)) : 99.0;
}

}  // namespace limpid::serve
