// Opens what the user chose to render: a scene, the light around it, and one of its cameras.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/progress.h"
#include "scene/load/load_options.h"
#include "scene/model/scene.h"

namespace limpid::scene {

/// All but the scene may be empty.
struct SceneSource {
    std::string scene;                ///< a file, or "builtin:NAME"
    std::string environment;          ///< a file, instead of the scene's own
    std::vector<std::string> lights;  ///< as framing/own_light.h reads each
    std::string background;           ///< ... and this
    std::string lightFile;            ///< changes to all of them (light_file.h)
    std::string assetRoot;            ///< empty: load_options.h, defaultAssetRoot()
    uint64_t maxImageMemory = image::defaultImageMemory;
};

/// Loads or makes the scene, gives it the environment and lights, and completes it (prepare.h). Throws
/// InputError and UsageError, and Cancelled as `progress` does.
Scene openScene(const SceneSource& source, const Progress& progress = {});

/// By name, or by number from 0; "" is the first. Throws UsageError listing the cameras if there is no such
/// camera.
const Camera& findCamera(const Scene& scene, const std::string& choice);

}  // namespace limpid::scene
