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

Scene dispatch(const std::filesystem::path& path, const LoadOptions& options) {
    const std::string extension = lowerCase(path.extension().string());
    if (extension == ".gltf" || extension == ".glb") return gltf::load(path, options);
    if (extension == ".obj") return loadObj(path, options);
    throw InputError(path, "is not a supported scene format (.gltf, .glb, .obj)");
}

}  // namespace

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
