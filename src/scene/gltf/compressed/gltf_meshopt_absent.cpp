// Replaces gltf_meshopt.cpp if meshoptimizer is not installed.
#include "scene/gltf/compressed/gltf_meshopt.h"

namespace limpid::scene::gltf {

bool canDecodeMeshopt() {
    return false;
}

std::vector<std::byte> decodeMeshopt(const Object&, const Object& extension, std::span<const std::byte>) {
    extension.fail("this build has no meshoptimizer");
}

}  // namespace limpid::scene::gltf
