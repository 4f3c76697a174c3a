// How a primitive's vertices make triangles ("mode" in glTF 2.0, section 3.7.2.1).
#pragma once

#include <cstdint>

namespace limpid::scene::gltf {

/// Smaller numbers are points and lines.
enum PrimitiveMode : uint64_t { Triangles = 4, TriangleStrip = 5, TriangleFan = 6 };

}  // namespace limpid::scene::gltf
