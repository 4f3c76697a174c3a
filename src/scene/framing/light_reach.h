// How much of what a camera sees is lit by the scene's own lights: a rough estimate, before rendering.
#pragma once

#include <cstdint>

#include "scene/model/scene.h"

namespace limpid::scene {

struct LightReach {
    uint32_t surfaces = 0;  ///< pixels of a small picture that see a surface
    uint32_t dark = 0;      ///< ... and no light within the path tracer's default number of bounces

    /// 0 if no surface is seen.
    double darkShare() const { return surfaces > 0 ? double{1.0} * dark / surfaces : 0.0; }
};

/// A few thousand paths on the host, the same ones every time; environments are not looked at. Light that is
/// ten stops below the mean of all surfaces counts as none: it is black on a screen.
LightReach estimateLightReach(const Scene& scene, const Camera& camera);

}  // namespace limpid::scene
