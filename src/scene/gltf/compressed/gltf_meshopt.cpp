#include "scene/gltf/compressed/gltf_meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <string>

namespace limpid::scene::gltf {
namespace {

/// An attribute block of 256 constant elements takes 4 bytes for each byte of an element; triangles and
/// indices take at least a byte each.
constexpr uint64_t greatestExpansion = 64;  // Document::decodedPerByte covers it

enum class Mode { Attributes, Triangles, Indices };
enum class Filter { None, Octahedral, Quaternion, Exponential };

struct Layout {
    Mode mode = Mode::Attributes;
    Filter filter = Filter::None;
    size_t count = 0;
    size_t stride = 0;
};

Mode readMode(const Object& extension) {
    const std::string mode = extension.text("mode");
    if (mode == "ATTRIBUTES") return Mode::Attributes;
    if (mode == "TRIANGLES") return Mode::Triangles;
    if (mode == "INDICES") return Mode::Indices;
    extension.fail("mode", "is '" + mode.substr(0, 20) + "', which is none of the extension's");
}

Filter readFilter(const Object& extension) {
    const std::string filter = extension.text("filter", "NONE");
    if (filter == "NONE") return Filter::None;
    if (filter == "OCTAHEDRAL") return Filter::Octahedral;
    if (filter == "QUATERNION") return Filter::Quaternion;
    if (filter == "EXPONENTIAL") return Filter::Exponential;
    extension.fail("filter", "is '" + filter.substr(0, 20) + "', which is none of the extension's");
}

bool strideFits(Mode mode, Filter filter, uint64_t stride) {
    if (mode != Mode::Attributes) return stride == 2 || stride == 4;
    if (filter == Filter::Octahedral) return stride == 4 || stride == 8;
    if (filter == Filter::Quaternion) return stride == 8;
    return stride > 0 && stride <= 256 && stride % 4 == 0;
}

/// Checks what the library assumes without checking.
Layout readLayout(const Object& view, const Object& extension, size_t encodedBytes) {
    Layout layout{readMode(extension), readFilter(extension)};
    const uint64_t stride = extension.whole("byteStride"), count = extension.whole("count");
    if (layout.mode != Mode::Attributes && layout.filter != Filter::None)
        extension.fail("filter", "is for the mode ATTRIBUTES only");
    if (!strideFits(layout.mode, layout.filter, stride))
        extension.fail("byteStride", fmt::format("is {}, which its mode and filter do not allow", stride));
    if (view.whole("byteStride", stride) != stride)
        view.fail("byteStride", fmt::format("is not the compressed data's {}", stride));
    if (layout.mode == Mode::Triangles && count % 3 != 0)
        extension.fail("count", fmt::format("is {}, no multiple of 3", count));
    if (count > view.whole("byteLength") || count * stride != view.whole("byteLength")) {
        view.fail("byteLength", fmt::format("is {}, not that of {} elements of {} bytes",
                                            view.whole("byteLength"), count, stride));
    }
    if (count * stride / greatestExpansion > encodedBytes) {
        extension.fail("count", fmt::format("is {}: more than {} bytes can hold", count, encodedBytes));
    }
    layout.count = static_cast<size_t>(count);
    layout.stride = static_cast<size_t>(stride);
    return layout;
}

int decodeStream(const Layout& layout, std::span<const std::byte> encoded, std::vector<std::byte>& decoded) {
    const auto* stream = reinterpret_cast<const unsigned char*>(encoded.data());
    const size_t length = encoded.size();
    switch (layout.mode) {
        case Mode::Attributes:
            return meshopt_decodeVertexBuffer(decoded.data(), layout.count, layout.stride, stream, length);
        case Mode::Triangles:
            return meshopt_decodeIndexBuffer(decoded.data(), layout.count, layout.stride, stream, length);
        case Mode::Indices:
            return meshopt_decodeIndexSequence(decoded.data(), layout.count, layout.stride, stream, length);
    }
    return -1;
}

void applyFilter(const Layout& layout, std::vector<std::byte>& decoded) {
    switch (layout.filter) {
        case Filter::None:
            break;
        case Filter::Octahedral:
            meshopt_decodeFilterOct(decoded.data(), layout.count, layout.stride);
            break;
        case Filter::Quaternion:
            meshopt_decodeFilterQuat(decoded.data(), layout.count, layout.stride);
            break;
        case Filter::Exponential:
            meshopt_decodeFilterExp(decoded.data(), layout.count, layout.stride);
            break;
    }
}

}  // namespace

bool canDecodeMeshopt() {
    return true;
}

std::vector<std::byte> decodeMeshopt(const Object& view, const Object& extension,
                                     std::span<const std::byte> encoded) {
    const Layout layout = readLayout(view, extension, encoded.size());
    std::vector<std::byte> decoded(layout.count * layout.stride);
    if (layout.count == 0) return decoded;
    if (const int error = decodeStream(layout, encoded, decoded); error != 0) {
        extension.fail(
            fmt::format("its {} bytes are damaged: meshoptimizer's error {}", encoded.size(), error));
    }
    applyFilter(layout, decoded);
    return decoded;
}

}  // namespace limpid::scene::gltf
