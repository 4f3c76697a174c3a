#include "scene_options.h"

#include <fmt/format.h>

#include "base/error.h"
#include "scene/builtin.h"
#include "scene/environment.h"
#include "scene/load.h"
#include "scene/prepare.h"

namespace limpid::cli {

void addSceneOptions(CLI::App& command, SceneChoice& choice) {
    std::string builtins;
    for (const scene::BuiltinInfo& info : scene::builtinScenes()) builtins += " builtin:" + info.name;
    command
        .add_option("SCENE", choice.scene,
                    "A .gltf, .glb or .obj file, or one of" + builtins + " builtin:room-N")
        ->required();
    command.add_option("--env", choice.environment, "Environment map, .hdr or .exr, lat-long");
    command.add_option("--camera", choice.camera, "Camera by name or number; default: the first");
}

scene::Scene loadChosenScene(const SceneChoice& choice) {
    constexpr std::string_view prefix = "builtin:";
    scene::Scene scene = choice.scene.starts_with(prefix)
                             ? scene::builtinScene(choice.scene.substr(prefix.size()))
                             : scene::loadScene(choice.scene);
    if (!choice.environment.empty()) scene.environment = scene::loadEnvironment(choice.environment);
    scene::prepare(scene);
    return scene;
}

const scene::Camera& chosenCamera(const scene::Scene& scene, const std::string& choice) {
    if (choice.empty()) return scene.cameras.front();
    std::string known;
    for (size_t i = 0; i < scene.cameras.size(); ++i) {
        const scene::Camera& camera = scene.cameras[i];
        if (camera.name == choice || std::to_string(i) == choice) return camera;
        known += fmt::format(" {} '{}'", i, camera.name);
    }
    throw UsageError("the scene has no camera '" + choice + "'; its cameras are" + known);
}

}  // namespace limpid::cli
