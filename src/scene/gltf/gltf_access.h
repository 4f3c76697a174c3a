// Accessors: typed arrays in a glTF document's buffers, as vectors. Sparse ones are filled in, normalised
// integers become floats, one without a buffer view is zeros.
//
// Specification: glTF 2.0, section 3.6.2 (accessors),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#accessors
//
// Every function takes an accessor's index, in range, and throws InputError if the accessor has another shape
// than asked for, reaches beyond its buffer view, or has more than `maxElements` elements
// (without a buffer view: than 4096 and one for each byte of the document).
#pragma once

#include <cstdint>
#include <vector>

#include "scene/gltf/gltf_document.h"

namespace limpid::scene::gltf {

inline constexpr uint64_t maxElements = uint64_t{1} << 28;

/// How many elements it states; nothing but the limit is checked.
uint64_t accessorCount(const Document& document, int accessor);
/// How many numbers one element has: 1 (SCALAR) to 16 (MAT4).
size_t accessorComponents(const Document& document, int accessor);

/// Numbers of one component each.
std::vector<float> readScalars(const Document& document, int accessor);
/// All numbers of all elements, which have `components` components each.
std::vector<float> readNumbers(const Document& document, int accessor, size_t components);
std::vector<vec2> readVec2(const Document& document, int accessor);
std::vector<vec3> readVec3(const Document& document, int accessor);
std::vector<vec4> readVec4(const Document& document, int accessor);
/// Three or four components; a missing alpha is 1.
std::vector<vec4> readColors(const Document& document, int accessor);
std::vector<mat4> readMat4(const Document& document, int accessor);
/// Unsigned integers of any width; not range-checked.
std::vector<uint32_t> readIndices(const Document& document, int accessor);
std::vector<uvec4> readJoints(const Document& document, int accessor);

}  // namespace limpid::scene::gltf
