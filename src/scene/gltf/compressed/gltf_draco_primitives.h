// Draco primitives made ordinary: after this, nothing that reads accessors needs to know of Draco.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/gltf/gltf_json.h"

namespace limpid::scene::gltf {

class Document;

/// Decodes what every primitive with KHR_draco_mesh_compression refers to, appends it to `buffers`, and
/// changes `json` (the document's own) so that the primitive reads it from there, as a list of triangles: new
/// buffer views, new accessors, no extension. Primitives that are the same share the new accessors. Returns
/// whether anything changed, in which case Objects made of `json` before are stale. `bytesLeft` is reduced by
/// what was appended. Throws InputError if a stream is bad (gltf_draco.h) or does not fit its accessors, or
/// is beyond `bytesLeft`.
bool expandDracoPrimitives(Document& document, Json& json, std::vector<std::vector<std::byte>>& buffers,
                           uint64_t& bytesLeft);

}  // namespace limpid::scene::gltf
