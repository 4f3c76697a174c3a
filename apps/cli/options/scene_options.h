// SCENE, --env and --camera, the same for every command that loads a scene.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "scene/load/scene_source.h"

namespace limpid::cli {

struct SceneChoice {
    scene::SceneSource source;
    std::string camera;
    std::vector<float> eye, target;  ///< three numbers each, or none: instead of the scene's cameras
    std::vector<float> up;           ///< three numbers, with these; none: +Y
    float fov = 0.0f;                ///< degrees, with these; 0: that of the camera
};

/// `required`: SCENE must be given.
void addSceneOptions(CLI::App& command, SceneChoice& choice, bool required = true);

/// By name, or by number from 0; the first if none is chosen; or one that stands at `eye`. Throws UsageError,
/// listing the cameras if there is none of that name.
scene::Camera chosenCamera(const scene::Scene& scene, const SceneChoice& choice);

}  // namespace limpid::cli
