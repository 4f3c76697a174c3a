// Lights that the user adds to a scene: one lamp or sun, and a different background.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/model/scene.h"

namespace limpid::scene {

struct OwnLight {
    std::vector<PunctualLight> lamps;  ///< added to the scene's own
    /// Constant radiance from all directions, replacing the scene's environment; black: none.
    std::optional<vec3> background;
};

/// Parses "KIND,X,Y,Z,INTENSITY". point: at X,Y,Z (world units), INTENSITY is radiant intensity; sun:
/// infinitely far in the direction of X,Y,Z, INTENSITY is the irradiance of a surface that faces it. Both are
/// white and work like KHR_lights_punctual. "": none. Throws UsageError.
std::optional<PunctualLight> parseLamp(const std::string& text);
/// Parses "R,G,B", none below 0. "": none. Throws UsageError.
std::optional<vec3> parseBackground(const std::string& text);

/// Call it before prepare(), which may give a dark scene a soft sky unless the user chose a background.
void addOwnLight(Scene& scene, const OwnLight& light);

}  // namespace limpid::scene
