// Estimates roughly, before rendering, how much of the camera's view is lit by the scene's own lights.
#pragma once

#include <cstdint>

#include "scene/model/scene.h"

namespace limpid::scene {

struct LightReach {
    uint32_t surfaces = 0;  ///< pixels of a small picture that show a surface
    uint32_t dark = 0;      ///< those of them that receive no light within the path tracer's default number
                            ///< of bounces

    /// Returns 0 if no surface is visible.
    double darkShare() const { return surfaces > 0 ? double{1.0} * dark / surfaces : 0.0; }
};

/// Traces a few thousand paths on the CPU, always the same ones; ignores environments. Light ten stops below
/// the mean of all surfaces counts as none, since it looks black on a screen.
LightReach estimateLightReach(const Scene& scene, const Camera& camera);

}  // namespace limpid::scene
