#include "scene/gltf/document/gltf_document.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/files/file_kind.h"
#include "base/log.h"
#include "scene/gltf/compressed/gltf_draco.h"
#include "scene/gltf/compressed/gltf_draco_primitives.h"
#include "scene/gltf/compressed/gltf_meshopt.h"

namespace limpid::scene::gltf {
namespace {

constexpr size_t maxWarnings = 16;

/// Supported extensions, except the compressions, which depend on the build.
constexpr std::array supportedExtensions = {"KHR_materials_anisotropy",
                                            "KHR_materials_diffuse_transmission",
                                            "KHR_materials_dispersion",
                                            "KHR_materials_sheen",
                                            "KHR_lights_punctual",
                                            "KHR_materials_clearcoat",
                                            "KHR_materials_emissive_strength",
                                            "KHR_materials_ior",
                                            "KHR_materials_iridescence",
                                            "KHR_materials_specular",
                                            "KHR_materials_transmission",
                                            "KHR_materials_unlit",
                                            "KHR_materials_volume",
                                            "KHR_mesh_quantization",
                                            "KHR_texture_transform"};
/// Metadata that does not affect pictures, so it is ignored without a warning.
constexpr std::array harmlessExtensions = {"KHR_xmp", "KHR_xmp_json_ld"};

template <size_t N>
bool contains(const std::array<const char*, N>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

bool isSupported(const std::string& name) {
    if (name == meshoptExtension) return canDecodeMeshopt();
    if (name == dracoExtension) return canDecodeDraco();
    return contains(supportedExtensions, name) || contains(harmlessExtensions, name);
}

uint32_t littleEndian(std::span<const std::byte> bytes, size_t at) {
    uint32_t value = 0;
    for (size_t i = 0; i < 4; ++i) value |= std::to_integer<uint32_t>(bytes[at + i]) << (8 * i);
    return value;
}

constexpr uint32_t glbMagic = 0x46546C67;   // "glTF"
constexpr uint32_t jsonChunk = 0x4E4F534A;  // "JSON"
constexpr uint32_t binChunk = 0x004E4942;   // "BIN\0"

struct Chunk {
    uint32_t type;
    std::span<const std::byte> data;
};

/// Returns the chunks of a GLB after checking that their lengths fit the file.
std::vector<Chunk> readChunks(const std::filesystem::path& file, std::span<const std::byte> content) {
    if (content.size() < 12) throw InputError(file, "is too short for a GLB header");
    if (const uint32_t version = littleEndian(content, 4); version != 2) {
        throw InputError(file, fmt::format("is GLB version {}, only 2 is supported", version));
    }
    const size_t length = littleEndian(content, 8);
    if (length > content.size()) {
        throw InputError(file, fmt::format("is truncated: {} bytes of {}", content.size(), length));
    }
    std::vector<Chunk> chunks;
    size_t at = 12;
    while (length >= at + 8 && chunks.size() < 64) {
        const size_t size = littleEndian(content, at);
        if (size > length - at - 8) {
            throw InputError(file, fmt::format("its GLB chunk {} does not fit the file", chunks.size()));
        }
        chunks.push_back({littleEndian(content, at + 4), content.subspan(at + 8, size)});
        at += 8 + size;
    }
    if (chunks.empty() || chunks[0].type != jsonChunk)
        throw InputError(file, "its first GLB chunk is not JSON");
    return chunks;
}

/// Throws InputError unless the content looks like JSON with an object (or a list, which the parser then
/// rejects).
void requireJsonText(const std::filesystem::path& file, std::span<const std::byte> content) {
    std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    const size_t first = text.find_first_not_of(" \t\r\n");
    if (first != std::string_view::npos && (text[first] == '{' || text[first] == '[')) return;
    throw InputError(file, "is neither GLB nor a glTF document: " + describeBeginning(content));
}

constexpr int base64Value(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    if (c == '/' || c == '_') return 63;
    return -1;
}

}  // namespace

Document::Lists::Lists(const Object& r)
    : root(r),
      accessors(r.objects("accessors")),
      animations(r.objects("animations")),
      bufferViews(r.objects("bufferViews")),
      cameras(r.objects("cameras")),
      images(r.objects("images")),
      materials(r.objects("materials")),
      meshes(r.objects("meshes")),
      nodes(r.objects("nodes")),
      samplers(r.objects("samplers")),
      scenes(r.objects("scenes")),
      skins(r.objects("skins")),
      textures(r.objects("textures")) {
    if (const auto extension = r.extension("KHR_lights_punctual")) lights = extension->objects("lights");
}

Document::Document(const std::filesystem::path& file, const std::filesystem::path& assetRoot)
    : files_(file, assetRoot) {
    std::vector<std::byte> content = readSceneFile(file);
    byteCount_ = content.size();
    const std::vector<std::byte> text = takeJson(std::move(content));
    json_ = std::make_unique<Json>(parseJson(this->file(), text));
    const Object root(this->file(), *json_, "");
    lists_ = std::make_unique<const Lists>(root);
    checkAsset();
    checkExtensions();
    readBuffers();
    decodeViews();
    expandPrimitives();
}

Document::~Document() = default;

std::vector<std::byte> Document::takeJson(std::vector<std::byte> content) {
    const bool binary = content.size() >= 4 && littleEndian(content, 0) == glbMagic;
    if (!binary) {
        requireJsonText(file(), content);
        return content;
    }
    const std::vector<Chunk> chunks = readChunks(file(), content);
    const auto bin =
        std::find_if(chunks.begin(), chunks.end(), [](const Chunk& c) { return c.type == binChunk; });
    if (bin != chunks.end()) binaryChunk_.assign(bin->data.begin(), bin->data.end());
    return {chunks[0].data.begin(), chunks[0].data.end()};
}

void Document::checkAsset() const {
    const auto asset = root().object("asset");
    if (!asset) root().fail("has no \"asset\": this is not glTF 2.0");
    const std::string version = asset->text("version");
    if (!version.starts_with("2."))
        asset->fail("version", "is '" + version.substr(0, 20) + "', only 2.x is supported");
    if (const std::string least = asset->text("minVersion", "2.0"); least != "2.0") {
        asset->fail("minVersion", "is '" + least.substr(0, 20) + "', only 2.0 is supported");
    }
}

void Document::checkExtensions() {
    std::vector<std::string> missing, ignored;
    for (const std::string& name : root().texts("extensionsRequired")) {
        if (!isSupported(name)) missing.push_back(name);
    }
    if (!missing.empty()) {
        throw InputError(file(), fmt::format("requires what is not supported: {}", fmt::join(missing, ", ")));
    }
    for (const std::string& name : root().texts("extensionsUsed")) {
        if (!isSupported(name)) ignored.push_back(name);
    }
    if (!ignored.empty()) warn(fmt::format("extensions that are ignored: {}", fmt::join(ignored, ", ")));
}

void Document::readBuffers() {
    const std::vector<Object> buffers = root().objects("buffers");
    uint64_t total = 0;
    for (const Object& buffer : buffers) {
        if (isPlaceholder(buffer)) {
            buffers_.emplace_back();
            continue;
        }
        const uint64_t length = buffer.whole("byteLength");
        std::vector<std::byte> bytes;
        if (const std::string uri = buffer.text("uri"); isDataUri(uri)) {
            bytes = decodeDataUri(uri, buffer);
        } else if (buffer.has("uri")) {
            bytes = files_.read(decodePercent(uri));
        } else if (buffers_.empty()) {
            bytes = std::move(binaryChunk_);
        }
        if (bytes.size() < length)
            buffer.fail(fmt::format("has {} bytes of the {} it states", bytes.size(), length));
        total += bytes.size();
        if (total > SceneFiles::maxTotalBytes) buffer.fail("the buffers are too large together");
        bytes.resize(static_cast<size_t>(length));
        byteCount_ += length;
        buffers_.push_back(std::move(bytes));
    }
    decodedBytesLeft_ = std::min(decodedFloor + decodedPerByte * total, maxDecodedBytes);
}

/// True if a buffer only stands for the decoded data of its compressed views: it is marked so, or has no
/// data.
bool Document::isPlaceholder(const Object& buffer) const {
    if (!canDecodeMeshopt()) return false;
    const auto extension = buffer.extension(meshoptExtension);
    if (extension && extension->boolean("fallback", false)) return true;
    const bool hasData = buffer.has("uri") || (buffers_.empty() && !binaryChunk_.empty());
    const auto& views = lists_->bufferViews;
    return !hasData && std::any_of(views.begin(), views.end(), [](const Object& view) {
        return view.extension(meshoptExtension).has_value();
    });
}

void Document::decodeViews() {
    if (!canDecodeMeshopt()) return;
    const auto& views = lists_->bufferViews;
    for (size_t i = 0; i < views.size(); ++i) {
        const auto extension = views[i].extension(meshoptExtension);
        if (!extension) continue;
        if (views[i].whole("byteLength") > decodedBytesLeft_)
            views[i].fail("the document's compressed buffer views are too large together");
        const auto& decoded = decodedViews_[static_cast<int>(i)] =
            decodeMeshopt(views[i], *extension, slice(*extension));
        decodedBytesLeft_ -= decoded.size();
    }
}

void Document::expandPrimitives() {
    if (!canDecodeDraco()) return;
    if (!expandDracoPrimitives(*this, *json_, buffers_, decodedBytesLeft_)) return;
    lists_ = std::make_unique<const Lists>(Object(file(), *json_, ""));
}

std::span<const std::byte> Document::bytes(int bufferView) const {
    const auto decoded = decodedViews_.find(bufferView);
    if (decoded != decodedViews_.end()) return decoded->second;
    return slice(lists_->bufferViews[static_cast<size_t>(bufferView)]);
}

/// Returns the part of a buffer that a buffer view, or its compressed form, refers to.
std::span<const std::byte> Document::slice(const Object& view) const {
    const int buffer = view.index("buffer", buffers_.size());
    if (buffer == none) view.fail("has no buffer");
    const std::vector<std::byte>& content = buffers_[static_cast<size_t>(buffer)];
    const uint64_t offset = view.whole("byteOffset", 0);
    const uint64_t length = view.whole("byteLength");
    if (offset > content.size() || length > content.size() - offset) {
        view.fail(fmt::format("its bytes {} to {} are not inside its buffer of {}", offset, offset + length,
                              content.size()));
    }
    return std::span(content).subspan(static_cast<size_t>(offset), static_cast<size_t>(length));
}

std::vector<std::byte> Document::decodeDataUri(std::string_view uri, const Object& owner) {
    const size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) {
        owner.fail("uri", "is a data URI without base64 content");
    }
    const std::string_view text = uri.substr(comma + 1);
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') break;
        const int value = base64Value(c);
        if (value < 0) owner.fail("uri", "has a character that is not base64");
        bits = (bits << 6 | static_cast<uint32_t>(value)) & 0xFFFFFF;
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes.push_back(static_cast<std::byte>(bits >> count & 0xFF));
    }
    return bytes;
}

void Document::warn(const std::string& message) {
    if (warnings_.size() > maxWarnings || !warnings_.insert(message).second) return;
    if (warnings_.size() > maxWarnings) {
        log::warn("{}: further warnings are left out", file().string());
    } else {
        log::warn("{}: {}", file().string(), message);
    }
}

}  // namespace limpid::scene::gltf
