// Primitives whose vertices and triangles are stored as Draco streams.
//
// Specification: KHR_draco_mesh_compression,
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Khronos/KHR_draco_mesh_compression; Draco
// bitstream 2.2, https://google.github.io/draco/spec/
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf/document/gltf_json.h"

namespace limpid::scene::gltf {

inline constexpr const char* dracoExtension = "KHR_draco_mesh_compression";

/// True if this build includes Draco. Without it the extension is treated as unknown.
bool canDecodeDraco();

/// One attribute of the stream: the values of all points in sequence.
struct DracoAttribute {
    uint64_t componentType = 0;  ///< glTF's number for the type used in the stream
    size_t components = 0;
    std::vector<std::byte> values;
};

struct DracoMesh {
    std::vector<uint32_t> indices;           ///< three per triangle, below the number of points
    std::vector<DracoAttribute> attributes;  ///< in the order of the requested numbers
};

/// Limits from the document. The decoder rejects a stream that exceeds them before it allocates memory for
/// it.
struct DracoLimits {
    uint64_t points = 0;     ///< exactly
    uint64_t triangles = 0;  ///< at most
    uint64_t bytes = 0;      ///< of all attributes together, at most
};

/// Decodes `stream`; `wanted` are unique attribute numbers in it. Throws InputError, naming `extension`, if
/// the stream is damaged, is not a mesh of bitstream 2.2, has counts that violate `limits`, expands more than
/// is plausible for its length (gltf_draco.cpp), or lacks a wanted attribute.
DracoMesh decodeDraco(const Object& extension, std::span<const std::byte> stream,
                      std::span<const uint64_t> wanted, const DracoLimits& limits);

}  // namespace limpid::scene::gltf
