// Converts Draco primitives to ordinary ones, so that code that reads accessors need not know about Draco.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/gltf/document/gltf_json.h"

namespace limpid::scene::gltf {

class Document;

/// Decodes the stream of every primitive with KHR_draco_mesh_compression and appends the result to `buffers`.
/// Changes `json` (the document's own) so that the primitive reads it from there as a triangle list: new
/// buffer views, new accessors, no extension. Equal primitives share the new accessors. Returns true if
/// anything changed; Objects made of `json` before are then invalid. `bytesLeft` is reduced by the appended
/// bytes. Throws InputError if a stream is invalid (gltf_draco.h), does not fit its accessors, or exceeds
/// `bytesLeft`.
bool expandDracoPrimitives(Document& document, Json& json, std::vector<std::vector<std::byte>>& buffers,
                           uint64_t& bytesLeft);

}  // namespace limpid::scene::gltf
