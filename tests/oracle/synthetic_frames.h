// Frames of an analytic scene for tests of denoisers: exact G-buffers and motion without a renderer, noise as
// of one path a pixel, and the truth beneath it. A checkered floor at a grazing angle before a wall, a
// sphere, a box that turns and slides, a small emitter, and the sky.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "denoise/api/host_frame.h"

namespace limpid::test {

struct SyntheticOptions {
    bool cameraMoves = false;  ///< slides, approaches and turns; the view is meant for some sixty frames
    bool objectMoves = false;
    bool noise = true;
    bool orthographic = false;
    double scale = 1.0;  ///< of every length
};

class SyntheticScene {
  public:
    /// Numbers of instances and of materials.
    enum Id : uint32_t { Floor, Wall, Sphere, Box, Emitter };

    explicit SyntheticScene(const SyntheticOptions& options) : options_(options) {}

    /// Frames are numbered from 0, which has no previous one. Every layer is rounded to float32 once. The
    /// same arguments give the same frame; other seeds give independent noise.
    /// `reflectionMotion` is patchy, and partly wrong: of all but the wall and the emitter.
    denoise::HostFrame frame(int number, uint32_t width, uint32_t height, uint32_t seed) const;

    /// The noise-free beauty: four floats a pixel, alpha 1. The light on a surface point is the same in each
    /// frame, so that a history that follows it converges to this.
    std::vector<float> truth(int number, uint32_t width, uint32_t height) const;

  private:
    SyntheticOptions options_;
};

}  // namespace limpid::test
