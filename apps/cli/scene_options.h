// SCENE, --env and --camera, the same for every command that loads a scene.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "scene/scene.h"

namespace limpid::cli {

struct SceneChoice {
    std::string scene;
    std::string environment;
    std::string camera;
};

void addSceneOptions(CLI::App& command, SceneChoice& choice);

/// Loads or makes the scene, gives it the environment, and completes it (scene/prepare.h).
scene::Scene loadChosenScene(const SceneChoice& choice);

/// By name, or by number from 0; the first if `choice` is empty. Throws UsageError listing the cameras.
const scene::Camera& chosenCamera(const scene::Scene& scene, const std::string& choice);

}  // namespace limpid::cli
