// SCENE, --env and --camera, the same for every command that loads a scene.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "scene/model/load_options.h"
#include "scene/model/scene.h"

namespace limpid::cli {

struct SceneChoice {
    std::string scene;
    std::string environment;
    std::vector<std::string> lights;  ///< as scene/framing/own_light.h reads each
    std::string background;           ///< ... and this
    std::string lightFile;            ///< changes to all of them (scene/model/light_file.h); empty: none
    std::string camera;
    std::vector<float> eye, target;  ///< three numbers each, or none: instead of the scene's cameras
    std::vector<float> up;           ///< three numbers, with these; none: +Y
    float fov = 0.0f;                ///< degrees, with these; 0: that of the camera
    std::string assetRoot;           ///< empty: scene/model/load_options.h, defaultAssetRoot()
    uint64_t maxImageMemory = image::defaultImageMemory;
};

void addSceneOptions(CLI::App& command, SceneChoice& choice);

/// Loads or makes the scene, gives it the environment, and completes it (scene/model/prepare.h).
scene::Scene loadChosenScene(const SceneChoice& choice);

/// By name, or by number from 0; the first if none is chosen; or one that stands at `eye`. Throws UsageError,
/// listing the cameras if there is none of that name.
scene::Camera chosenCamera(const scene::Scene& scene, const SceneChoice& choice);

}  // namespace limpid::cli
