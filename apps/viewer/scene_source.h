// What is on show, as the command line says it.
#pragma once

#include <string>
#include <vector>

namespace limpid::viewer {

/// All but the scene may be empty. `assetRoot`: as --asset-root says; empty: that of a scene which is named.
struct SceneSource {
    std::string scene, environment;
    std::vector<std::string> lights;  ///< each a --light
    std::string background;
    std::string lightFile;  ///< --lights of the first scene
    std::string assetRoot;
};

}  // namespace limpid::viewer
