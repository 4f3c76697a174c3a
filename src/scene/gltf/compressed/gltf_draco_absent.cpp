// Replaces gltf_draco.cpp if Draco is not installed.
#include "scene/gltf/compressed/gltf_draco.h"

namespace limpid::scene::gltf {

bool canDecodeDraco() {
    return false;
}

DracoMesh decodeDraco(const Object& extension, std::span<const std::byte>, std::span<const uint64_t>,
                      const DracoLimits&) {
    extension.fail("this build has no Draco");
}

}  // namespace limpid::scene::gltf
