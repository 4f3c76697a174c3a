// Reads accessors, the typed arrays in a glTF document's buffers, as vectors. Sparse accessors are filled in,
// normalised integers become floats, and accessors without a buffer view are zeros.
//
// Specification: glTF 2.0, section 3.6.2 (accessors),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#accessors
//
// Every function takes a valid accessor index. It throws InputError if the accessor does not have the
// requested shape, reaches beyond its buffer view, or has more than `maxElements` elements (without a buffer
// view: more than 4096 plus one for each byte of the document).
#pragma once

#include <cstdint>
#include <vector>

#include "scene/gltf/document/gltf_document.h"

namespace limpid::scene::gltf {

inline constexpr uint64_t maxElements = uint64_t{1} << 28;

/// Returns the number of elements in the accessor's description; checks only the limit.
uint64_t accessorCount(const Document& document, int accessor);
/// Returns the number of components of an element: 1 (SCALAR) to 16 (MAT4).
size_t accessorComponents(const Document& document, int accessor);

/// Reads elements with one component each.
std::vector<float> readScalars(const Document& document, int accessor);
/// Reads all components of all elements, which have `components` components each.
std::vector<float> readNumbers(const Document& document, int accessor, size_t components);
std::vector<vec2> readVec2(const Document& document, int accessor);
std::vector<vec3> readVec3(const Document& document, int accessor);
std::vector<vec4> readVec4(const Document& document, int accessor);
/// Reads three or four components; a missing alpha is 1.
std::vector<vec4> readColors(const Document& document, int accessor);
/// Reads the first `most` elements, or all if there are fewer.
std::vector<mat4> readMat4(const Document& document, int accessor, size_t most);
/// Reads unsigned integers of any width, without a range check.
std::vector<uint32_t> readIndices(const Document& document, int accessor);
std::vector<uvec4> readJoints(const Document& document, int accessor);

}  // namespace limpid::scene::gltf
