#include "scene/obj/obj_material.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "base/log.h"
#include "base/text/lower_case.h"

namespace limpid::scene {
namespace {

/// A map statement: the file and the options that Limpid uses.
struct Map {
    std::string file;  ///< relative to the scene's folder
    vec2 scale{1.0f};
    vec2 offset{0.0f};
    bool clamp = false;
};

/// Valid statements that are ignored, to warn about each once.
using Ignored = std::set<std::string, std::less<>>;

/// The statements of a material as written.
struct Statements {
    std::string name;
    std::optional<vec3> ambient, diffuse, specular, emission, filter;
    std::optional<Map> diffuseMap, emissionMap, normalMap, alphaMap;
    std::optional<float> roughness;
    float metallic = 0.0f;
    float shininess = 0.0f;
    float alpha = 1.0f;
    float ior = 0.0f;
    int illumination = 2;
};

vec3 readColor(const Lines& lines, Words& words) {
    const std::string_view first = words.next();
    if (first == "spectral" || first == "xyz") lines.fail("only RGB colours are read");
    vec3 color(lines.number(first));
    // A single number stands for all three.
    if (!words.peek().empty()) color = {color.x, lines.number(words.next()), lines.number(words.next())};
    return glm::max(color, vec3(0.0f));
}

vec2 readPair(const Lines& lines, Words& words, vec2 value) {
    for (int i = 0; i < 3; ++i) {
        const auto number = lines.tryNumber(words.peek());
        if (!number) break;
        words.next();
        if (i < 2) value[i] = *number;
    }
    return value;
}

Map readMap(const Lines& lines, Words& words, const std::filesystem::path& folder) {
    Map map;
    while (words.peek().starts_with('-') && words.peek().size() > 1) {
        const std::string_view option = words.next();
        if (option == "-s") {
            map.scale = readPair(lines, words, map.scale);
        } else if (option == "-o") {
            map.offset = readPair(lines, words, map.offset);
        } else if (option == "-t") {
            readPair(lines, words, vec2(0.0f));
        } else if (option == "-clamp") {
            map.clamp = words.next() == "on";
        } else {
            words.next();
            if (option == "-mm") words.next();
        }
    }
    if (words.rest().empty()) lines.fail("a map without a file name");
    std::string name(words.rest());
    std::replace(name.begin(), name.end(), '\\', '/');
    // An absolute name stays absolute and is rejected later.
    map.file = (folder / name).generic_string();
    return map;
}

void readMapStatement(std::string_view key, const Lines& lines, Words& words,
                      const std::filesystem::path& folder, Statements& m, Ignored& ignored) {
    const auto map = [&] { return readMap(lines, words, folder); };
    if (key == "map_Kd") {
        m.diffuseMap = map();
    } else if (key == "map_Ke") {
        m.emissionMap = map();
    } else if (key == "norm") {
        m.normalMap = map();
    } else if (key == "map_d") {
        m.alphaMap = map();
    } else if (key.starts_with("map_") || key == "bump" || key == "disp" || key == "decal" || key == "refl") {
        if (ignored.size() < 16) ignored.emplace(key);
    }
}

void readStatement(const Lines& lines, std::string_view line, const std::filesystem::path& folder,
                   Statements& m, Ignored& ignored) {
    Words words(line);
    const std::string_view key = words.next();
    const auto number = [&] { return lines.number(words.next()); };
    if (key == "Ka") m.ambient = readColor(lines, words);
    if (key == "Kd") m.diffuse = readColor(lines, words);
    if (key == "Ks") m.specular = readColor(lines, words);
    if (key == "Ke") m.emission = readColor(lines, words);
    if (key == "Tf") m.filter = readColor(lines, words);
    if (key == "Ns") m.shininess = std::max(number(), 0.0f);
    if (key == "Ni") m.ior = number();
    if (key == "Pr") m.roughness = number();
    if (key == "Pm") m.metallic = number();
    if (key == "Tr") m.alpha = 1.0f - number();
    if (key == "illum") m.illumination = static_cast<int>(std::clamp(number(), 0.0f, 100.0f));
    if (key == "d") {
        if (words.peek() == "-halo") words.next();
        m.alpha = number();
    }
    readMapStatement(key, lines, words, folder, m, ignored);
}

bool isNamedLight(std::string_view name) {
    return lowerCase(name).find("light") != std::string::npos;
}

float largest(const vec3& v) {
    return std::max(v.x, std::max(v.y, v.z));
}

float clamp01(float value) {
    return std::clamp(value, 0.0f, 1.0f);
}

/// Loads the maps of one scene's materials.
class MapReader {
  public:
    MapReader(SceneFiles& files, TexturePool& textures) : files_(files), textures_(textures) {}

    TextureRef operator()(const std::optional<Map>& map, bool srgb) {
        TextureRef ref;
        if (!map) return ref;
        Sampler sampler;
        if (map->clamp) sampler.wrapU = sampler.wrapV = Wrap::ClampToEdge;
        const std::string name = (files_.sceneFile().parent_path() / map->file).string();
        ref.texture = textures_.add(name, srgb, sampler,
                                    [&] { return files_.read(map->file, textures_.maxImageMemory()); });
        // -s and -o act on OBJ's coordinates (v up); ours are v' = 1 - v.
        ref.rowU = {map->scale.x, 0.0f, map->offset.x};
        ref.rowV = {0.0f, map->scale.y, 1.0f - map->scale.y - map->offset.y};
        return ref;
    }

  private:
    SceneFiles& files_;
    TexturePool& textures_;
};

void setEmission(const Statements& m, MapReader& read, Material& material) {
    if (m.emission) material.emission = *m.emission;
    if (m.emissionMap && material.emission == vec3(0.0f)) material.emission = vec3(1.0f);
    material.emissionTexture = read(m.emissionMap, true);
    // Without the texture, the factor alone would make the whole surface glow.
    if (m.emissionMap && !material.emissionTexture) material.emission = vec3(0.0f);
    const bool isSilent = !m.emission && !m.emissionMap;
    if (isSilent && m.ambient && isNamedLight(m.name)) material.emission = *m.ambient;
}

void setAlpha(const Statements& m, Material& material) {
    material.baseColor.a = clamp01(m.alpha);
    if (m.alpha < 1.0f) material.alphaMode = AlphaMode::Blend;
    if (!m.alphaMap) return;
    if (m.diffuseMap && m.diffuseMap->file == m.alphaMap->file) {
        material.alphaMode = AlphaMode::Mask;
    } else {
        log::warn("material '{}': map_d is ignored, it is not the alpha of map_Kd", m.name);
    }
}

/// Sets up mirrors and glass. Returns true for glass.
bool setIllumination(const Statements& m, Material& material) {
    if (m.illumination == 5) {
        const vec3 specular = m.specular.value_or(vec3(0.0f));
        const vec3 color = specular == vec3(0.0f) ? vec3(material.baseColor) : specular;
        material.baseColor = vec4(glm::min(color, vec3(1.0f)), material.baseColor.a);
        material.metallic = 1.0f;
        material.roughness = m.roughness ? clamp01(*m.roughness) : 0.0f;
    }
    const bool maybeGlass = m.illumination == 4 || m.illumination == 9;
    if (m.illumination != 6 && m.illumination != 7 && !(maybeGlass && m.alpha < 1.0f)) return false;
    material.baseColor = vec4(glm::min(m.filter.value_or(vec3(1.0f)), vec3(1.0f)), 1.0f);
    material.transmission = 1.0f;
    material.thin = false;
    material.specular = 1.0f;
    material.roughness = m.roughness ? clamp01(*m.roughness) : 0.0f;
    material.doubleSided = false;
    return true;
}

Material toMaterial(const Statements& m, MapReader& read) {
    Material material = greyMaterial();
    material.name = m.name;
    material.baseColorTexture = read(m.diffuseMap, true);
    const vec3 absent = material.baseColorTexture ? vec3(1.0f) : vec3(material.baseColor);
    vec3 color = m.diffuse.value_or(absent);
    if (m.diffuseMap && color == vec3(0.0f)) color = absent;
    material.baseColor = vec4(glm::min(color, vec3(1.0f)), 1.0f);
    material.normalTexture = read(m.normalMap, false);
    material.metallic = clamp01(m.metallic);
    material.specular = clamp01(largest(m.specular.value_or(vec3(0.0f))));
    material.roughness = clamp01(m.roughness.value_or(std::pow(2.0f / (m.shininess + 2.0f), 0.25f)));
    if (m.ior > 1.0f) material.ior = std::min(m.ior, 1e3f);
    setEmission(m, read, material);
    if (!setIllumination(m, material)) setAlpha(m, material);
    return material;
}

}  // namespace

Material greyMaterial() {
    Material material;
    material.name = "grey";
    material.baseColor = vec4(0.8f, 0.8f, 0.8f, 1.0f);
    material.metallic = 0.0f;
    material.specular = 0.0f;
    material.doubleSided = true;
    return material;
}

void readMaterials(Lines lines, const std::filesystem::path& folder, SceneFiles& files, TexturePool& textures,
                   Scene& scene, std::map<std::string, int, std::less<>>& names) {
    MapReader read(files, textures);
    std::optional<Statements> current;
    Ignored ignored;
    const auto finish = [&] {
        if (!current) return;
        const auto [entry, isNew] =
            names.try_emplace(current->name, static_cast<int>(scene.materials.size()));
        if (isNew) scene.materials.push_back(toMaterial(*current, read));
    };
    while (const auto line = lines.next()) {
        Words words(*line);
        if (words.next() == "newmtl") {
            finish();
            current.emplace().name = std::string(words.rest());
        } else if (current) {
            readStatement(lines, *line, folder, *current, ignored);
        }
    }
    finish();
    if (!ignored.empty()) log::warn("{}: ignored: {}", lines.file().string(), fmt::join(ignored, ", "));
}

}  // namespace limpid::scene
