// Light that a user adds to a scene: one lamp or sun, and another background.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/model/scene.h"

namespace limpid::scene {

struct OwnLight {
    std::vector<PunctualLight> lamps;  ///< besides the scene's own
    /// Radiance from everywhere around, instead of the scene's environment; black: none.
    std::optional<vec3> background;
};

/// "KIND,X,Y,Z,INTENSITY". point: at X,Y,Z (world units), radiant intensity; sun: far away in the direction
/// of X,Y,Z, irradiance of what faces it; both white, as KHR_lights_punctual has them. "": none. Throws
/// UsageError.
std::optional<PunctualLight> parseLamp(const std::string& text);
/// "R,G,B", none below 0. "": none. Throws UsageError.
std::optional<vec3> parseBackground(const std::string& text);

/// Before prepare(), which may give a dark scene a soft sky: not if the user chose a background.
void addOwnLight(Scene& scene, const OwnLight& light);

}  // namespace limpid::scene
