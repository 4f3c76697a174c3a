// The lights that the panel changes: the scene's own, those that were added, and the background.
#pragma once

#include <string>
#include <vector>

#include "scene/lights/light_control.h"
#include "scene/load/scene_source.h"

namespace limpid::studio {

struct LightDesk {
    std::vector<scene::LightControl> lights;    ///< as they are
    std::vector<scene::LightControl> original;  ///< as they were loaded
    int firstAdded = 0;                         ///< lamp: this one and those after it are --light's
    bool hasBackground = false;                 ///< instead of the scene's environment
    vec3 background{0.5f};

    /// Of a scene just loaded from `source`.
    void show(const std::vector<scene::LightControl>& loaded, const scene::SceneSource& source);
    /// The background that the source has, also if another one was chosen.
    void showBackground(const scene::SceneSource& source);
    /// Takes over what a hand did to lights that are still there. `sameSky`: the environment is one of them.
    void carry(const LightDesk& before, bool sameSky = true);
    bool isChanged() const { return lights != original; }
    void reset() { lights = original; }
    bool isAdded(const scene::LightControl& light) const;
    /// As for --background; empty: none.
    std::string backgroundText() const;
};

/// An added lamp goes: its text from `source`, and `desk` as if it had never been there.
void removeLamp(int index, scene::SceneSource& source, LightDesk& desk);

/// As for --light: a lamp where the eye is, or a sun from above, that is neither dim nor blinding at this
/// exposure for what the camera looks at.
std::string newLamp(bool sun, const vec3& eye, const vec3& target, float stops);

}  // namespace limpid::studio
