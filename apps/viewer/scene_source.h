// What is on show, as the command line says it.
#pragma once

#include <string>

namespace limpid::viewer {

/// All but the scene may be empty.
struct SceneSource {
    std::string scene, environment, light, background;
};

}  // namespace limpid::viewer
