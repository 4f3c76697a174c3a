// limpid info SCENE: what a scene holds, and what --camera and --animation choose of it.
#pragma once

#include <string>

namespace limpid::cli {

/// Throws as loading the scene does.
void printSceneInfo(const std::string& scene, bool asJson);

}  // namespace limpid::cli
