// Frames of an analytic scene for tests of denoisers: exact G-buffers and motion without a renderer, noise
// like one path per pixel, and the noise-free result. A checkered floor at a grazing angle in front of a
// wall, a sphere, a box that rotates and slides, a small emitter, and the sky.
#pragma once

#include <compare>
#include <glm/glm.hpp>
#include <vector>

#include "denoise/api/host_frame.h"

namespace limpid::test {

struct SyntheticOptions {
    bool cameraMoves = false;  ///< slides, approaches and turns; designed for about sixty frames
    bool objectMoves = false;
    bool noise = true;
    bool orthographic = false;
    double scale = 1.0;  ///< factor of every length

    auto operator<=>(const SyntheticOptions&) const = default;
};

class SyntheticScene {
  public:
    /// Numbers of instances and materials.
    enum Id : uint32_t { Floor, Wall, Sphere, Box, Emitter };

    explicit SyntheticScene(const SyntheticOptions& options) : options_(options) {}
    const SyntheticOptions& options() const { return options_; }

    /// Frames are numbered from 0, which has no previous frame. Every layer is rounded to float32 once. The
    /// same arguments give the same frame; other seeds give independent noise. `reflectionMotion` is patchy
    /// and partly wrong, except on the wall and the emitter.
    denoise::HostFrame frame(int number, uint32_t width, uint32_t height, uint32_t seed) const;

    /// Returns the noise-free beauty: four floats per pixel, alpha 1. The light on a surface point is the
    /// same in each frame, so that a history that follows it converges to this.
    std::vector<float> truth(int number, uint32_t width, uint32_t height) const;

  private:
    SyntheticOptions options_;
};

}  // namespace limpid::test
