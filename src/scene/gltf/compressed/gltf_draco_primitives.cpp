#include "scene/gltf/compressed/gltf_draco_primitives.h"

#include <fmt/format.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "scene/gltf/compressed/gltf_draco.h"
#include "scene/gltf/document/gltf_access.h"
#include "scene/gltf/document/gltf_document.h"
#include "scene/gltf/document/primitive_mode.h"

namespace limpid::scene::gltf {
namespace {

/// A primitive's Draco extension, checked against the primitive.
struct Source {
    int view = none, indices = none;
    uint64_t mode = Triangles;
    std::vector<std::string> names;  ///< of the attributes in the stream
    std::vector<int> accessors;      ///< of these attributes
    std::vector<uint64_t> numbers;   ///< of these attributes, in the stream

    std::string key() const {
        std::string text = fmt::format("{} {} {}", view, indices, mode);
        for (size_t i = 0; i < names.size(); ++i)
            text += fmt::format(" {}={}:{}", names[i], accessors[i], numbers[i]);
        return text;
    }
};

/// The accessors that replace those of a primitive.
struct Expanded {
    std::vector<std::pair<std::string, size_t>> attributes;
    size_t indices = 0;
};

class Expander {
  public:
    Expander(Document& document, size_t buffers, uint64_t bytesLeft)
        : document_(document), lists_(document.lists()), firstBuffer_(buffers), bytesLeft_(bytesLeft) {}

    void run() {
        for (size_t m = 0; m < lists_.meshes.size(); ++m) {
            const std::vector<Object> primitives = lists_.meshes[m].objects("primitives");
            for (size_t p = 0; p < primitives.size(); ++p) {
                const auto extension = primitives[p].extension(dracoExtension);
                if (!extension) continue;
                const Source source = readSource(primitives[p], *extension);
                const auto [entry, isNew] = known_.try_emplace(source.key());
                if (isNew) entry->second = expand(source, *extension);
                changes_.push_back({m, p, &entry->second});
            }
        }
    }

    bool empty() const { return changes_.empty(); }
    uint64_t bytesLeft() const { return bytesLeft_; }

    void apply(Json& json, std::vector<std::vector<std::byte>>& buffers) {
        for (const auto& [name, added] : {std::pair{"accessors", &accessors_}, {"bufferViews", &views_}}) {
            auto& list = json[name].get_ref<Json::array_t&>();
            list.insert(list.end(), added->begin(), added->end());
        }
        for (const Change& change : changes_) {
            Json& primitive = json["meshes"][change.mesh]["primitives"][change.primitive];
            for (const auto& [name, accessor] : change.expanded->attributes) {
                primitive["attributes"][name] = accessor;
            }
            primitive["indices"] = change.expanded->indices;
            primitive["mode"] = uint64_t{Triangles};
            primitive["extensions"].erase(dracoExtension);
        }
        for (auto& buffer : buffers_) buffers.push_back(std::move(buffer));
    }

  private:
    struct Change {
        size_t mesh, primitive;
        const Expanded* expanded;
    };

    Source readSource(const Object& primitive, const Object& extension) {
        Source source;
        source.mode = primitive.whole("mode", Triangles);
        if (source.mode != Triangles && source.mode != TriangleStrip)
            primitive.fail("mode", fmt::format("is {}; Draco has triangles only", source.mode));
        source.view = extension.index("bufferView", lists_.bufferViews.size());
        if (source.view == none) extension.fail("has no bufferView");
        source.indices = primitive.index("indices", lists_.accessors.size());
        const auto numbers = extension.object("attributes"), attributes = primitive.object("attributes");
        if (!numbers || !attributes) extension.fail("it or its primitive has no attributes");
        for (const std::string& name : numbers->keys()) {
            const int accessor = attributes->index(name.c_str(), lists_.accessors.size());
            if (accessor == none) {
                document_.warn(numbers->place() + ": not all of them are attributes of the primitive");
                continue;
            }
            source.names.push_back(name);
            source.accessors.push_back(accessor);
            source.numbers.push_back(numbers->whole(name.c_str()));
        }
        if (source.names.empty()) extension.fail("none of its attributes are the primitive's");
        return source;
    }

    DracoLimits limitsOf(const Source& source) const {
        DracoLimits limits;
        limits.points = accessorCount(document_, source.accessors[0]);
        for (const int accessor : source.accessors) {
            if (accessorCount(document_, accessor) == limits.points) continue;
            lists_.accessors[static_cast<size_t>(accessor)].fail("count",
                                                                 "differs from that of other attributes");
        }
        limits.triangles = maxElements / 3;
        if (source.indices != none) {
            const uint64_t count = accessorCount(document_, source.indices);
            limits.triangles = source.mode == Triangles ? count / 3 : count;
        }
        limits.bytes = bytesLeft_;
        return limits;
    }

    Expanded expand(const Source& source, const Object& extension) {
        const DracoMesh mesh =
            decodeDraco(extension, document_.bytes(source.view), source.numbers, limitsOf(source));
        if (source.indices != none && source.mode == Triangles &&
            mesh.indices.size() != accessorCount(document_, source.indices)) {
            lists_.accessors[static_cast<size_t>(source.indices)].fail(
                "count", fmt::format("is not the {} of its Draco stream", mesh.indices.size()));
        }
        std::vector<std::byte> buffer;
        Expanded expanded;
        for (size_t i = 0; i < source.names.size(); ++i) {
            expanded.attributes.emplace_back(source.names[i],
                                             addAttribute(source.accessors[i], mesh.attributes[i], buffer));
        }
        const std::span<const std::byte> indices = std::as_bytes(std::span(mesh.indices));
        expanded.indices = addAccessor(
            indices, buffer,
            {{"componentType", uint64_t{5125}}, {"count", mesh.indices.size()}, {"type", "SCALAR"}});
        if (buffer.size() > bytesLeft_) extension.fail("the document's Draco streams are too large together");
        bytesLeft_ -= buffer.size();
        buffers_.push_back(std::move(buffer));
        return expanded;
    }

    size_t addAttribute(int index, const DracoAttribute& attribute, std::vector<std::byte>& buffer) {
        const Object& accessor = lists_.accessors[static_cast<size_t>(index)];
        if (accessorComponents(document_, index) != attribute.components) {
            accessor.fail("type", fmt::format("is '{}', but its Draco attribute has {} components",
                                              accessor.text("type"), attribute.components));
        }
        return addAccessor(attribute.values, buffer,
                           {{"componentType", attribute.componentType},
                            {"count", accessorCount(document_, index)},
                            {"type", accessor.text("type")},
                            {"normalized", accessor.boolean("normalized", false)}});
    }

    size_t addAccessor(std::span<const std::byte> values, std::vector<std::byte>& buffer, Json accessor) {
        buffer.resize((buffer.size() + 3) / 4 * 4);
        views_.push_back({{"buffer", firstBuffer_ + buffers_.size()},
                          {"byteOffset", buffer.size()},
                          {"byteLength", values.size()}});
        buffer.insert(buffer.end(), values.begin(), values.end());
        accessor["bufferView"] = lists_.bufferViews.size() + views_.size() - 1;
        accessors_.push_back(std::move(accessor));
        return lists_.accessors.size() + accessors_.size() - 1;
    }

    Document& document_;
    const Document::Lists& lists_;
    size_t firstBuffer_;
    uint64_t bytesLeft_;
    std::map<std::string, Expanded> known_;  ///< key: Source::key
    std::vector<Change> changes_;
    Json::array_t accessors_, views_;
    std::vector<std::vector<std::byte>> buffers_;
};

}  // namespace

bool expandDracoPrimitives(Document& document, Json& json, std::vector<std::vector<std::byte>>& buffers,
                           uint64_t& bytesLeft) {
    Expander expander(document, buffers.size(), bytesLeft);
    expander.run();
    if (expander.empty()) return false;
    expander.apply(json, buffers);
    bytesLeft = expander.bytesLeft();
    return true;
}

}  // namespace limpid::scene::gltf
