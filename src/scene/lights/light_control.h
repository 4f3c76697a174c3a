// Editable values of a scene's lights: punctual lights, emissive materials, the environment.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scene/model/scene.h"

namespace limpid::scene {

/// One light. `color` times `brightness` is the light's intensity (PunctualLight), the material's emission,
/// or the factor of the environment.
struct LightControl {
    enum class Kind { Lamp, Emitter, Environment } kind = Kind::Lamp;
    int index = 0;  ///< index into Scene::lights or Scene::materials
    std::string name;
    bool on = true;
    vec3 color{1.0f};         ///< none below 0
    float brightness = 1.0f;  ///< relative to the file's value; not below 0
    PunctualLight::Kind lamp = PunctualLight::Kind::Point;
    vec3 position{0.0f};                ///< for point and spot lights
    vec3 direction{0.0f, 0.0f, -1.0f};  ///< for directional and spot lights: the direction in which the light
                                        ///< travels, unit
    float turn = 0.0f;                  ///< for the environment: degrees about +Y
    bool operator==(const LightControl&) const = default;
};

/// Returns the current values of every light of a prepared scene (scene/prepare/prepare.h).
std::vector<LightControl> lightControlsOf(const Scene& scene);

/// Applies the values in `controls` that differ from `before`, the result of lightControlsOf() for this
/// scene. A light that is off has no power. A light that is moved no longer follows its node. No light is
/// added or removed: the data that buildSceneData() makes of the scene keeps its size.
void applyLightControls(Scene& scene, std::span<const LightControl> controls,
                        std::span<const LightControl> before);

}  // namespace limpid::scene
