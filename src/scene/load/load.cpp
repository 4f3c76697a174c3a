#include "scene/load/load.h"

#include <new>
#include <stdexcept>
#include <string>

#include "base/error.h"
#include "base/text/lower_case.h"
#include "scene/gltf/gltf_load.h"
#include "scene/load/validate.h"
#include "scene/obj/obj.h"

namespace limpid::scene {
namespace {

std::string extensionOf(const std::filesystem::path& path) {
    return lowerCase(path.extension().string());
}

Scene dispatch(const std::filesystem::path& path, const LoadOptions& options) {
    if (!isSceneFile(path)) throw InputError(path, "is not a supported scene format (.gltf, .glb, .obj)");
    return extensionOf(path) == ".obj" ? loadObj(path, options) : gltf::load(path, options);
}

}  // namespace

bool isSceneFile(const std::filesystem::path& path) {
    const std::string extension = extensionOf(path);
    return extension == ".gltf" || extension == ".glb" || extension == ".obj";
}

Scene loadScene(const std::filesystem::path& path, const LoadOptions& options) {
    try {
        Scene scene = dispatch(path, options);
        if (const auto fault = findFault(scene)) throw InputError(path, *fault);
        return scene;
    } catch (const std::bad_alloc&) {
        throw InputError(path, "does not fit into memory");
    } catch (const std::length_error&) {
        throw InputError(path, "does not fit into memory");
    }
}

}  // namespace limpid::scene
