#include "picture_target.h"

#include "image/io/picture.h"
#include "scene/lights/environment.h"
#include "scene/load/validate.h"
#include "scratch.h"

namespace limpid::fuzz {

bool readsAsRadiance(const std::filesystem::path& path) {
    scene::Scene scene;
    scene.materials.emplace_back();
    const bool isEnvironment = accepts([&] { scene.environment = scene::loadEnvironment(path); });
    if (isEnvironment) {
        if (const auto fault = scene::findFault(scene)) throw Error(*fault);
        pack(scene);
    }
    const bool isPicture = accepts([&] { image::readPicture(path); });
    return isEnvironment && isPicture;
}

}  // namespace limpid::fuzz
