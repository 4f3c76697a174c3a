// Cameras and punctual lights of glTF nodes.
//
// Specification: glTF 2.0, section 3.10 (cameras),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#cameras; KHR_lights_punctual,
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_lights_punctual
#pragma once

#include <string>

#include "scene/gltf/gltf_document.h"

namespace limpid::scene::gltf {

/// A camera where `toWorld` puts it; the transform's scale and shear do not matter. Throws InputError if the
/// camera has no type that glTF knows, or a field of view or magnification that is not positive.
Camera readCamera(const Object& source, const mat4& toWorld, const std::string& nodeName);

/// A light where `toWorld` puts it. Units stay glTF's: candela, lux. Throws InputError on an unknown type.
PunctualLight readLight(Document& document, const Object& source, const mat4& toWorld,
                        const std::string& nodeName);

}  // namespace limpid::scene::gltf
