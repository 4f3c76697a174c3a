#include "scene/obj/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "scene/device/texture_pool.h"
#include "scene/load/scene_files.h"
#include "scene/obj/obj_material.h"
#include "scene/obj/obj_polygon.h"
#include "scene/obj/obj_text.h"
#include "scene/prepare/mesh_repair.h"

namespace limpid::scene {
namespace {

constexpr size_t maxGroups = size_t{1} << 20;
constexpr size_t linesPerReport = 1 << 12;  ///< between two reports of the progress

/// Indices into the file's lists, from 0; `none` if the face gives none.
struct Corner {
    int position = none, uv = none, normal = none;
    bool operator==(const Corner&) const = default;
};

struct CornerHash {
    size_t operator()(const Corner& c) const {
        uint64_t hash = static_cast<uint32_t>(c.position);
        hash = hash * 0x9E3779B97F4A7C15u ^ static_cast<uint32_t>(c.uv);
        hash = hash * 0x9E3779B97F4A7C15u ^ static_cast<uint32_t>(c.normal);
        hash *= 0x9E3779B97F4A7C15u;
        return hash ^ hash >> 32;
    }
};

struct Group {
    std::string name;
    std::vector<Corner> corners;  ///< three per triangle
    std::vector<int> materials;   ///< one per triangle
};

class ObjLoader {
  public:
    ObjLoader(const std::filesystem::path& file, const LoadOptions& options)
        : files_(file, options.assetRoot),
          textures_(scene_, {file, TexturePool::Formats::TgaAndBmpToo, options.maxImageMemory}),
          content_(readSceneFile(file)),
          lines_(file, content_),
          progress_(options.progress) {}

    Scene run();

  private:
    void readLine(std::string_view line);
    void readVertex(Words& words);
    void readFace(Words& words);
    Corner readCorner(std::string_view word) const;
    int readIndex(std::string_view text, size_t size, const char* kind) const;
    void useMaterial(std::string_view name);
    void useLibraries(std::string_view names);
    bool tryLibrary(const std::string& name);
    bool libraryExists(const std::string& name);
    int greyIndex();
    void startGroup(std::string_view name);
    void finishGroup();
    Mesh toMesh(const Group& group) const;

    Scene scene_;
    SceneFiles files_;
    TexturePool textures_;
    std::vector<std::byte> content_;
    Lines lines_;
    Progress progress_;
    std::vector<vec3> positions_, normals_;
    std::vector<vec3> colors_;  ///< one per position, or empty
    std::vector<vec2> uvs_;
    std::map<std::string, int, std::less<>> materials_;
    std::set<std::string, std::less<>> unknown_;  ///< material and library names warned about
    std::set<std::string, std::less<>> libraries_;
    int material_ = none;
    int grey_ = none;
    Group group_;
    size_t repaired_ = 0;
    size_t notDrawn_ = 0;  ///< points, lines, curves and surfaces
};

Scene ObjLoader::run() {
    scene_.name = files_.sceneFile().stem().string();
    for (size_t read = 0; const auto line = lines_.next(); ++read) {
        if (read % linesPerReport == 0) progress_.at(lines_.readBytes(), content_.size());
        readLine(*line);
    }
    finishGroup();
    if (scene_.instances.empty()) throw InputError(files_.sceneFile(), "has no triangles to draw");
    if (scene_.materials.empty()) scene_.materials.push_back(greyMaterial());
    scene_.files = files_.used();
    if (repaired_ > 0) log::warn("{}: {} normals repaired", files_.sceneFile().string(), repaired_);
    if (notDrawn_ > 0)
        log::warn("{}: points, lines, curves and surfaces are not drawn: {}", files_.sceneFile().string(),
                  notDrawn_);
    return std::move(scene_);
}

void ObjLoader::readLine(std::string_view line) {
    Words words(line);
    const std::string_view key = words.next();
    const auto number = [&] { return lines_.number(words.next()); };
    if (key == "v") {
        readVertex(words);
    } else if (key == "vn") {
        const float x = number(), y = number();
        normals_.emplace_back(x, y, number());
    } else if (key == "vt") {
        const float u = number();
        uvs_.emplace_back(u, words.peek().empty() ? 1.0f : 1.0f - number());
    } else if (key == "f") {
        readFace(words);
    } else if (key == "usemtl") {
        useMaterial(words.rest());
    } else if (key == "mtllib") {
        useLibraries(words.rest());
    } else if (key == "o" || key == "g") {
        startGroup(words.rest());
    } else if (key == "p" || key == "l" || key == "curv" || key == "curv2" || key == "surf") {
        ++notDrawn_;
    }
}

void ObjLoader::readVertex(Words& words) {
    const auto number = [&] { return lines_.number(words.next()); };
    const float x = number(), y = number();
    positions_.emplace_back(x, y, number());
    float extra[3] = {1, 1, 1};
    int count = 0;
    while (count < 3 && !words.peek().empty()) extra[count++] = number();
    const bool isColored = count == 3;  // a single additional number is a weight, which only curves use
    if (isColored && colors_.empty()) colors_.resize(positions_.size() - 1, vec3(1.0f));
    if (isColored || !colors_.empty()) {
        colors_.push_back(isColored ? vec3(extra[0], extra[1], extra[2]) : vec3(1.0f));
    }
}

int ObjLoader::readIndex(std::string_view text, size_t size, const char* kind) const {
    int64_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error != std::errc() || end != text.data() + text.size()) {
        lines_.fail(fmt::format("'{}' is not the index of a {}", text.substr(0, 40), kind));
    }
    // Negative indices count back from the newest element; -1 is the last one.
    const auto count = static_cast<int64_t>(size);
    if (index == 0 || index > count || index < -count) {
        lines_.fail(fmt::format("{} {} does not exist, there are {} so far", kind, index, size));
    }
    return static_cast<int>(index > 0 ? index - 1 : count + index);
}

/// Parses "v", "v/vt", "v//vn" or "v/vt/vn".
Corner ObjLoader::readCorner(std::string_view word) const {
    Corner corner;
    const size_t first = word.find('/');
    corner.position = readIndex(word.substr(0, first), positions_.size(), "vertex");
    if (first == std::string_view::npos) return corner;
    const std::string_view tail = word.substr(first + 1);
    const size_t second = tail.find('/');
    const std::string_view uv = tail.substr(0, second);
    if (!uv.empty()) corner.uv = readIndex(uv, uvs_.size(), "texture coordinate");
    if (second == std::string_view::npos) return corner;
    const std::string_view normal = tail.substr(second + 1);
    if (!normal.empty()) corner.normal = readIndex(normal, normals_.size(), "normal");
    return corner;
}

void ObjLoader::readFace(Words& words) {
    std::vector<Corner> corners;
    while (!words.peek().empty()) corners.push_back(readCorner(words.next()));
    if (corners.size() < 3) lines_.fail("a face with fewer than three corners");
    if (material_ == none) material_ = greyIndex();
    std::vector<vec3> places;
    for (const Corner& corner : corners) places.push_back(positions_[static_cast<size_t>(corner.position)]);
    for (const auto& triangle : triangulate(places)) {
        for (const uint32_t i : triangle) group_.corners.push_back(corners[i]);
        group_.materials.push_back(material_);
    }
}

int ObjLoader::greyIndex() {
    if (grey_ == none) {
        grey_ = static_cast<int>(scene_.materials.size());
        scene_.materials.push_back(greyMaterial());
    }
    return grey_;
}

void ObjLoader::useMaterial(std::string_view name) {
    if (const auto known = materials_.find(name); known != materials_.end()) {
        material_ = known->second;
        return;
    }
    material_ = greyIndex();
    if (unknown_.size() < 16 && unknown_.emplace(name).second) {
        log::warn("{}: line {}: no material '{}', grey is used", files_.sceneFile().string(), lines_.line(),
                  name);
    }
}

bool ObjLoader::tryLibrary(const std::string& name) {
    if (libraries_.contains(name)) return true;
    if (!libraryExists(name)) return false;
    const std::filesystem::path path = files_.resolve(name);
    libraries_.insert(name);
    const std::vector<std::byte> text = files_.read(name);
    readMaterials(Lines(path, text), std::filesystem::path(name).parent_path(), files_, textures_, scene_,
                  materials_);
    return true;
}

/// A rejected name counts as missing, but the warning gives the reason.
bool ObjLoader::libraryExists(const std::string& name) {
    try {
        std::error_code error;
        return std::filesystem::is_regular_file(files_.resolve(name), error);
    } catch (const InputError& refusal) {
        if (unknown_.size() < 16 && unknown_.insert(name).second) log::warn("{}", refusal.what());
        return false;
    }
}

void ObjLoader::useLibraries(std::string_view names) {
    if (names.empty()) lines_.fail("mtllib without a file name");
    std::string all(names);
    std::replace(all.begin(), all.end(), '\\', '/');
    // The rest of the line may be one name with blanks or several names; the format does not say, so try
    // both.
    if (tryLibrary(all)) return;
    Words words(all);
    while (!words.peek().empty()) {
        const std::string name(words.next());
        if (tryLibrary(name) || unknown_.size() >= 16 || !unknown_.insert(name).second) continue;
        log::warn("{}: line {}: there is no material file '{}', grey is used", files_.sceneFile().string(),
                  lines_.line(), name);
    }
}

void ObjLoader::startGroup(std::string_view name) {
    finishGroup();
    group_.name = std::string(name);
}

void ObjLoader::finishGroup() {
    if (group_.corners.empty()) return;
    if (scene_.meshes.size() >= maxGroups) lines_.fail(fmt::format("more than {} groups", maxGroups));
    const auto [least, most] = std::minmax_element(group_.materials.begin(), group_.materials.end());
    const int first = *least;
    if (*most - first > std::numeric_limits<uint16_t>::max()) lines_.fail("too many materials");
    Mesh mesh = toMesh(group_);
    if (*most > first) {
        for (const int material : group_.materials)
            mesh.materialSlots.push_back(static_cast<uint16_t>(material - first));
    }
    const Repairs repairs = repairAttributes(mesh);
    repaired_ += repairs.rescaledNormals + repairs.recomputedNormals;
    scene_.instances.push_back({static_cast<int>(scene_.meshes.size()), first, mat4(1.0f), mesh.name});
    scene_.meshes.push_back(std::move(mesh));
    group_ = {};
}

Mesh ObjLoader::toMesh(const Group& group) const {
    Mesh mesh;
    mesh.name = group.name;
    const auto any = [&](int Corner::*index) {
        return std::any_of(group.corners.begin(), group.corners.end(),
                           [&](const Corner& c) { return c.*index != none; });
    };
    const bool hasUvs = any(&Corner::uv);
    const bool hasNormals = any(&Corner::normal);
    std::unordered_map<Corner, uint32_t, CornerHash> known;
    for (const Corner& corner : group.corners) {
        const auto [entry, isNew] = known.try_emplace(corner, static_cast<uint32_t>(mesh.positions.size()));
        // A corner without a normal in a mesh with normals gets its own vertex, with the face's normal.
        const bool isLonely = hasNormals && corner.normal == none;
        mesh.indices.push_back(isLonely ? static_cast<uint32_t>(mesh.positions.size()) : entry->second);
        if (!isNew && !isLonely) continue;
        mesh.positions.push_back(positions_[static_cast<size_t>(corner.position)]);
        if (hasUvs) mesh.uv0.push_back(corner.uv == none ? vec2(0.0f) : uvs_[static_cast<size_t>(corner.uv)]);
        if (hasNormals)
            mesh.normals.push_back(corner.normal == none ? vec3(0.0f)
                                                         : normals_[static_cast<size_t>(corner.normal)]);
        if (!colors_.empty()) mesh.colors.emplace_back(colors_[static_cast<size_t>(corner.position)], 1.0f);
    }
    return mesh;
}

}  // namespace

Scene loadObj(const std::filesystem::path& file, const LoadOptions& options) {
    return ObjLoader(file, options).run();
}

}  // namespace limpid::scene
