// Decodes compressed buffer views.
//
// Specification: EXT_meshopt_compression,
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_meshopt_compression
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scene/gltf/document/gltf_json.h"

namespace limpid::scene::gltf {

inline constexpr const char* meshoptExtension = "EXT_meshopt_compression";

/// True if this build includes meshoptimizer. Without it the extension is treated as unknown: a file that
/// requires it is rejected; if a file includes uncompressed data too, that is read instead.
bool canDecodeMeshopt();

/// Returns the bytes of `view`, whose extension object `extension` refers to `encoded`. Throws InputError if
/// the two objects break a rule of the extension or the stream is damaged. Memory is limited to 64 times the
/// stream's length: no valid stream expands more.
std::vector<std::byte> decodeMeshopt(const Object& view, const Object& extension,
                                     std::span<const std::byte> encoded);

}  // namespace limpid::scene::gltf
