// Reads cameras and punctual lights of glTF nodes.
//
// Specification: glTF 2.0, section 3.10 (cameras),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#cameras; KHR_lights_punctual,
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_lights_punctual
#pragma once

#include <string>

#include "scene/gltf/document/gltf_document.h"

namespace limpid::scene::gltf {

/// Returns a camera placed by `toWorld`; scale and shear of the transform are ignored. Throws InputError if
/// the camera's type is unknown, or its field of view or magnification is not positive.
Camera readCamera(const Object& source, const mat4& toWorld, const std::string& nodeName);

/// Returns a light placed by `toWorld`, in glTF's units: candela, lux. Throws InputError if its type is
/// unknown.
PunctualLight readLight(Document& document, const Object& source, const mat4& toWorld,
                        const std::string& nodeName);

}  // namespace limpid::scene::gltf
