#include "scene/load/scene_source.h"

#include <fmt/format.h>

#include <string_view>

#include "base/error.h"
#include "scene/builtin/builtin.h"
#include "scene/framing/own_light.h"
#include "scene/lights/environment.h"
#include "scene/lights/light_file.h"
#include "scene/load/load.h"
#include "scene/prepare/prepare.h"

namespace limpid::scene {
namespace {

constexpr std::string_view builtinPrefix = "builtin:";

Scene loadFile(const SceneSource& source, const Progress& progress) {
    const LoadOptions options{.assetRoot = source.assetRoot.empty() ? defaultAssetRoot(source.scene)
                                                                    : std::filesystem::path(source.assetRoot),
                              .maxImageMemory = source.maxImageMemory,
                              .progress = progress};
    return loadScene(source.scene, options);
}

}  // namespace

Scene openScene(const SceneSource& source, const Progress& progress) {
    const bool builtin = source.scene.starts_with(builtinPrefix);
    Scene scene = builtin ? builtinScene(source.scene.substr(builtinPrefix.size()))
                          : loadFile(source, progress.part(0.0, 0.8));
    progress.at(0.8);
    if (!source.environment.empty())
        scene.environment = loadEnvironment(source.environment, source.maxImageMemory);
    progress.at(0.9);
    OwnLight own{{}, parseBackground(source.background)};
    for (const std::string& text : source.lights) {
        if (const auto lamp = parseLamp(text)) own.lamps.push_back(*lamp);
    }
    addOwnLight(scene, own);
    // Built-in scenes may be dark on purpose.
    prepare(scene, !source.background.empty() ? SkyRule::Never
                   : builtin                  ? SkyRule::WithoutLights
                                              : SkyRule::InTheDark);
    if (!source.lightFile.empty()) {
        const std::vector<LightControl> before = lightControlsOf(scene);
        applyLightControls(scene, readLightFile(source.lightFile, before), before);
    }
    return scene;
}

const Camera& findCamera(const Scene& scene, const std::string& choice) {
    if (choice.empty()) return scene.cameras.front();
    std::string known;
    for (size_t i = 0; i < scene.cameras.size(); ++i) {
        const Camera& camera = scene.cameras[i];
        if (camera.name == choice || std::to_string(i) == choice) return camera;
        known += fmt::format(" {} '{}'", i, camera.name);
    }
    throw UsageError("the scene has no camera '" + choice + "'; its cameras are" + known);
}

}  // namespace limpid::scene
