#include "scene/gltf/document/gltf_access.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

namespace limpid::scene::gltf {
namespace {

/// An accessor without a buffer view is zeros without using bytes in the file, and each use of it makes
/// vertices or triangles. Where it makes sense (the base of a sparse morph target), the document contains as
/// many vertices, of several bytes each.
uint64_t maxZeroElements(const Document& document) {
    return 4096 + document.byteCount();
}

enum class Component : uint32_t { I8 = 5120, U8 = 5121, I16 = 5122, U16 = 5123, U32 = 5125, F32 = 5126 };

size_t sizeOf(Component type) {
    switch (type) {
        case Component::I8:
        case Component::U8:
            return 1;
        case Component::I16:
        case Component::U16:
            return 2;
        case Component::U32:
        case Component::F32:
            return 4;
    }
    return 4;
}

Component componentType(const Object& owner) {
    const uint64_t number = owner.whole("componentType");
    if (number < 5120 || number > 5126 || number == 5124) {
        owner.fail("componentType", fmt::format("is {}, which is none of glTF's", number));
    }
    return static_cast<Component>(number);
}

size_t componentsOf(const Object& accessor) {
    const std::string type = accessor.text("type");
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4" || type == "MAT2") return 4;
    if (type == "MAT3") return 9;
    if (type == "MAT4") return 16;
    accessor.fail("type", "is '" + type.substr(0, 20) + "', which is none of glTF's");
}

/// Elements in a buffer: `data` covers all `count` of them. Empty data means zeros.
struct Elements {
    std::span<const std::byte> data;
    size_t stride = 0;
    size_t count = 0;
    Component type = Component::F32;
    size_t components = 1;
    bool normalized = false;
};

uint64_t countOf(const Object& owner) {
    const uint64_t count = owner.whole("count");
    if (count > maxElements)
        owner.fail("count", fmt::format("is {}, more than the {} accepted", count, maxElements));
    return count;
}

/// Finds the elements of `owner` (an accessor, or the indices or values of a sparse one) in its buffer view.
void locate(const Document& document, const Object& owner, bool mayStride, Elements& elements) {
    const auto& views = document.lists().bufferViews;
    const int index = owner.index("bufferView", views.size());
    const size_t elementSize = sizeOf(elements.type) * elements.components;
    elements.stride = elementSize;
    if (index == none) return;
    const Object& view = views[static_cast<size_t>(index)];
    const uint64_t stride = view.whole("byteStride", 0);
    if (stride > 252) view.fail("byteStride", fmt::format("is {}, more than glTF's 252", stride));
    if (stride != 0 && mayStride) elements.stride = static_cast<size_t>(stride);
    if (elements.stride < elementSize) {
        view.fail("byteStride", fmt::format("is {}, less than an element of {} bytes", stride, elementSize));
    }
    const std::span<const std::byte> bytes = document.bytes(index);
    const uint64_t offset = owner.whole("byteOffset", 0);
    const uint64_t length = elements.count == 0 ? 0 : (elements.count - 1) * elements.stride + elementSize;
    if (offset > bytes.size() || length > bytes.size() - offset) {
        owner.fail(fmt::format("its {} elements of {} bytes at {} are not inside its buffer view of {}",
                               elements.count, elementSize, offset, bytes.size()));
    }
    elements.data = bytes.subspan(static_cast<size_t>(offset), static_cast<size_t>(length));
}

Elements baseElements(const Document& document, const Object& accessor) {
    Elements elements;
    elements.type = componentType(accessor);
    elements.components = componentsOf(accessor);
    elements.normalized = accessor.boolean("normalized", false);
    elements.count = static_cast<size_t>(countOf(accessor));
    locate(document, accessor, true, elements);
    if (!accessor.has("bufferView") && elements.count > maxZeroElements(document)) {
        accessor.fail("count", fmt::format("is {}, too many for an accessor without data", elements.count));
    }
    return elements;
}

template <typename Source, typename Target>
Target convert(Source value, [[maybe_unused]] bool normalized) {
    if constexpr (std::is_floating_point_v<Target> && std::is_integral_v<Source>) {
        const auto number = static_cast<Target>(value);
        if (!normalized) return number;
        return std::max(number / static_cast<Target>(std::numeric_limits<Source>::max()), Target{-1});
    } else {
        return static_cast<Target>(value);
    }
}

template <typename Source, typename Target>
void copyElement(const std::byte* from, size_t components, bool normalized, Target* to) {
    for (size_t c = 0; c < components; ++c) {
        Source value;  // copied, since the data may be unaligned
        std::memcpy(&value, from + c * sizeof(Source), sizeof(Source));
        to[c] = convert<Source, Target>(value, normalized);
    }
}

/// Copies element i of `elements` to target[slot(i) * components ...], unless that is beyond the target's
/// end.
template <typename Target, typename Slot>
void copyElements(const Elements& elements, std::span<Target> target, const Slot& slot) {
    if (elements.data.empty()) return;
    for (size_t i = 0; i < elements.count; ++i) {
        const size_t place = slot(i) * elements.components;
        if (place >= target.size()) continue;
        const std::byte* from = elements.data.data() + i * elements.stride;
        Target* to = target.data() + place;
        switch (elements.type) {
            case Component::I8:
                copyElement<int8_t>(from, elements.components, elements.normalized, to);
                break;
            case Component::U8:
                copyElement<uint8_t>(from, elements.components, elements.normalized, to);
                break;
            case Component::I16:
                copyElement<int16_t>(from, elements.components, elements.normalized, to);
                break;
            case Component::U16:
                copyElement<uint16_t>(from, elements.components, elements.normalized, to);
                break;
            case Component::U32:
                copyElement<uint32_t>(from, elements.components, elements.normalized, to);
                break;
            case Component::F32:
                if constexpr (std::is_floating_point_v<Target>) {
                    copyElement<float>(from, elements.components, false, to);
                }
                break;
        }
    }
}

/// Replaces the elements that accessor.sparse lists.
template <typename Target>
void applySparse(const Document& document, const Object& accessor, const Elements& base,
                 std::span<Target> target) {
    const auto sparse = accessor.object("sparse");
    if (!sparse) return;
    const auto indices = sparse->object("indices");
    const auto values = sparse->object("values");
    if (!indices || !values) sparse->fail("has no indices or no values");
    const auto count = static_cast<size_t>(countOf(*sparse));
    if (count > base.count) sparse->fail("count", "is more than the accessor's");
    if (!indices->has("bufferView") || !values->has("bufferView")) sparse->fail("has no buffer view");

    Elements where{{}, 0, count, componentType(*indices), 1, false};
    if (where.type == Component::F32 || where.type == Component::I8 || where.type == Component::I16) {
        indices->fail("componentType", "is not an unsigned integer");
    }
    locate(document, *indices, false, where);
    std::vector<uint32_t> slots(count);
    copyElements(where, std::span(slots), [](size_t i) { return i; });
    for (const uint32_t slot : slots) {
        if (slot >= base.count) indices->fail(fmt::format("replaces element {} of {}", slot, base.count));
    }
    Elements replacement = base;
    replacement.data = {};
    replacement.count = count;
    locate(document, *values, false, replacement);
    copyElements(replacement, target, [&](size_t i) { return size_t{slots[i]}; });
}

struct Shape {
    size_t least, most;  ///< range of the number of components
    bool integers;       ///< unsigned integers only
};

void checkShape(const Object& accessor, const Elements& elements, const Shape& shape) {
    if (elements.components < shape.least || elements.components > shape.most) {
        accessor.fail("type",
                      fmt::format("has {} components where {} are needed", elements.components, shape.least));
    }
    const bool isUnsigned =
        elements.type == Component::U8 || elements.type == Component::U16 || elements.type == Component::U32;
    if (shape.integers && !isUnsigned) accessor.fail("componentType", "is not an unsigned integer");
    if (!shape.integers && elements.type == Component::U32) {
        accessor.fail("componentType", "is a 32-bit integer, which glTF allows for indices only");
    }
}

/// `most`: elements to read.
template <typename Target>
std::vector<Target> readFlat(const Document& document, int index, const Shape& shape, size_t& components,
                             size_t most = maxElements) {
    const Object& accessor = document.lists().accessors[static_cast<size_t>(index)];
    const Elements elements = baseElements(document, accessor);
    checkShape(accessor, elements, shape);
    components = elements.components;
    Elements wanted = elements;
    wanted.count = std::min(elements.count, most);
    std::vector<Target> target(wanted.count * components);
    copyElements(wanted, std::span(target), [](size_t i) { return i; });
    applySparse(document, accessor, elements, std::span(target));
    return target;
}

/// Reads rows of `N` numbers. If the document has fewer per row, the rest are `filler`.
template <typename Vector, typename Target>
std::vector<Vector> readRows(const Document& document, int index, const Shape& shape, Target filler) {
    size_t components = 0;
    const std::vector<Target> flat = readFlat<Target>(document, index, shape, components);
    std::vector<Vector> rows(flat.size() / components, Vector(filler));
    for (size_t i = 0; i < rows.size(); ++i) {
        for (size_t c = 0; c < components; ++c) rows[i][static_cast<int>(c)] = flat[i * components + c];
    }
    return rows;
}

}  // namespace

uint64_t accessorCount(const Document& document, int accessor) {
    return countOf(document.lists().accessors[static_cast<size_t>(accessor)]);
}

size_t accessorComponents(const Document& document, int accessor) {
    return componentsOf(document.lists().accessors[static_cast<size_t>(accessor)]);
}

std::vector<float> readNumbers(const Document& document, int accessor, size_t components) {
    size_t found = 0;
    return readFlat<float>(document, accessor, {components, components, false}, found);
}

std::vector<float> readScalars(const Document& document, int accessor) {
    return readNumbers(document, accessor, 1);
}

std::vector<vec2> readVec2(const Document& document, int accessor) {
    return readRows<vec2>(document, accessor, {2, 2, false}, 0.0f);
}

std::vector<vec3> readVec3(const Document& document, int accessor) {
    return readRows<vec3>(document, accessor, {3, 3, false}, 0.0f);
}

std::vector<vec4> readVec4(const Document& document, int accessor) {
    return readRows<vec4>(document, accessor, {4, 4, false}, 0.0f);
}

std::vector<vec4> readColors(const Document& document, int accessor) {
    return readRows<vec4>(document, accessor, {3, 4, false}, 1.0f);
}

std::vector<uvec4> readJoints(const Document& document, int accessor) {
    return readRows<uvec4>(document, accessor, {4, 4, true}, 0u);
}

std::vector<uint32_t> readIndices(const Document& document, int accessor) {
    size_t components = 0;
    return readFlat<uint32_t>(document, accessor, {1, 1, true}, components);
}

std::vector<mat4> readMat4(const Document& document, int accessor, size_t most) {
    size_t components = 0;
    const std::vector<float> flat = readFlat<float>(document, accessor, {16, 16, false}, components, most);
    std::vector<mat4> matrices(flat.size() / 16);
    for (size_t i = 0; i < flat.size(); ++i) {
        matrices[i / 16][static_cast<int>(i % 16 / 4)][static_cast<int>(i % 4)] = flat[i];
    }
    return matrices;
}

}  // namespace limpid::scene::gltf
