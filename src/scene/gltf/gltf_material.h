// Converts glTF materials to scene::Material.
//
// Specification: glTF 2.0, section 3.9 (materials),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#materials; KHR_materials_anisotropy,
// _clearcoat, _diffuse_transmission, _dispersion, _emissive_strength, _ior, _iridescence, _sheen, _specular,
// _transmission, _unlit, _volume,
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos
#pragma once

#include "scene/gltf/document/gltf_document.h"
#include "scene/gltf/gltf_texture.h"

namespace limpid::scene::gltf {

/// Throws InputError if a value has the wrong type or an index is out of range. Clamps factors outside their
/// range, with a warning; an emissive factor above 1 is kept.
Material readMaterial(Document& document, const Object& source, TextureLibrary& textures);

}  // namespace limpid::scene::gltf
