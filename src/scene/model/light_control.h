// A scene's lights as a hand changes them: punctual lights, emissive materials, the environment.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/model/scene.h"

namespace limpid::scene {

/// One of them. `color` times `brightness` is the light's intensity (PunctualLight), the material's emission,
/// or what the environment is multiplied by.
struct LightControl {
    enum class Kind { Lamp, Emitter, Environment } kind = Kind::Lamp;
    int index = 0;  ///< of Scene::lights, or of Scene::materials
    std::string name;
    bool on = true;
    vec3 color{1.0f};         ///< none below 0
    float brightness = 1.0f;  ///< of what the file says; not below 0
    PunctualLight::Kind lamp = PunctualLight::Kind::Point;
    vec3 position{0.0f};                ///< of lamps that stand somewhere
    vec3 direction{0.0f, 0.0f, -1.0f};  ///< of lamps that face somewhere: the way the light travels, unit
    float turn = 0.0f;                  ///< of the environment: degrees about +Y
    bool operator==(const LightControl&) const = default;
};

/// Every light of a complete scene (scene/model/prepare.h), as it is.
std::vector<LightControl> lightControlsOf(const Scene& scene);

/// Makes the lights be as `controls` say, where they differ from `before`, which lightControlsOf() gave for
/// this scene. A light that is off has no power. One that is moved no longer follows its node. No light is
/// added or removed: what buildSceneData() makes of the scene stays the same in size.
void applyLightControls(Scene& scene, std::span<const LightControl> controls,
                        std::span<const LightControl> before);

}  // namespace limpid::scene
