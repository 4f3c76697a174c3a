// Buffer views whose bytes are stored compressed.
//
// Specification: EXT_meshopt_compression,
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_meshopt_compression
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scene/gltf/gltf_json.h"

namespace limpid::scene::gltf {

inline constexpr const char* meshoptExtension = "EXT_meshopt_compression";

/// Whether this build has meshoptimizer. Without it the extension is as unknown as any other: a file that
/// requires it is refused, one that brings uncompressed data too is read from those.
bool canDecodeMeshopt();

/// The bytes of `view`, whose extension object is `extension` and refers to `encoded`. Throws InputError if
/// the two objects break a rule of the extension or the stream is damaged. Memory is bounded by 64 times the
/// stream's length: no valid stream expands more.
std::vector<std::byte> decodeMeshopt(const Object& view, const Object& extension,
                                     std::span<const std::byte> encoded);

}  // namespace limpid::scene::gltf
