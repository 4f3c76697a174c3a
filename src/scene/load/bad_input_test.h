// For the tests of malformed scene files: their fixture, and a document to damage.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "base/log.h"
#include "image/io/png/png.h"
#include "scene/load/loader_test_files.h"
#include "scene/prepare/prepare.h"

namespace limpid::scene::test {

class BadInput : public FolderTest {
  protected:
    BadInput() { log::setLevel(log::Level::Error); }
    ~BadInput() override {
        log::setLevel(log::Level::Info);
        EXPECT_LT(std::chrono::steady_clock::now() - begin_, std::chrono::seconds(120)) << "took too long";
    }

    fs::path write(const std::string& name, const std::string& content) {
        put(folder / name, content);
        return folder / name;
    }
    /// Saves a modified copy of `file` and expects that it is rejected.
    void expectFault(GltfFile file, const std::string& fault, const std::function<void(GltfFile&)>& change) {
        change(file);
        expectRefused(file.save(folder), fault);
    }
    /// Accepts either outcome: a proper rejection, or a scene that can be prepared.
    void expectLoadsOrIsRefused(const fs::path& path) {
        try {
            Scene scene = loadScene(path);
            prepare(scene);
            ++loaded;
        } catch (const InputError&) {
            ++refused;
        }
    }
    int loaded = 0;
    int refused = 0;

  private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

inline json parse(const char* text) {
    return json::parse(text);
}

/// A document that uses most features of the loader, so that mutations reach them.
inline GltfFile richFile(const fs::path& folder) {
    GltfFile file = square();
    image::writePng(folder / "a.png", {2, 2, 4, std::vector<uint8_t>(16, 200)});
    json& primitive = file.primitive();
    json& attributes = primitive["attributes"];
    attributes["TANGENT"] = file.addFloats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", 4);
    attributes["COLOR_0"] = file.addAccessor<uint8_t>(std::vector<uint8_t>(16, 255), "VEC4", 4, 5121);
    attributes["JOINTS_0"] = file.addAccessor<uint8_t>(std::vector<uint8_t>(16, 0), "VEC4", 4, 5121);
    attributes["WEIGHTS_0"] = file.addFloats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
    primitive["targets"] =
        json::array({{{"POSITION", file.addFloats(std::vector<float>(12, 0.5f), "VEC3", 3)}}});
    primitive["material"] = 0;
    const uint16_t where[] = {1};
    const float value[] = {2, 0, 0};
    const int indices = file.addView(where, sizeof where);
    const int values = file.addView(value, sizeof value);
    file.document["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
        {"values", {{"bufferView", values}}}};
    file.document["meshes"][0]["weights"] = {0.5};
    file.document["skins"] = parse(R"([{"joints": [1]}])");
    file.document["nodes"] =
        parse(R"([{"mesh": 0, "children": [1, 2]}, {"camera": 0, "translation": [0, 0, 3]},
        {"mesh": 0, "skin": 0, "rotation": [0, 0, 0, 1], "scale": [1, 2, 3],
         "extensions": {"KHR_lights_punctual": {"light": 0}}}, {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}])");
    file.document["cameras"] =
        parse(R"([{"type": "perspective", "perspective": {"yfov": 1, "aspectRatio": 1}}])");
    file.document["extensions"] =
        parse(R"({"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {}}]}})");
    file.document["images"] = parse(R"([{"uri": "a.png"}])");
    file.document["samplers"] = parse(R"([{"wrapS": 33071, "minFilter": 9984, "magFilter": 9728}])");
    file.document["textures"] = parse(R"([{"source": 0, "sampler": 0}])");
    file.document["materials"] =
        parse(R"([{"alphaMode": "MASK", "alphaCutoff": 0.5, "emissiveFactor": [1, 1, 1],
        "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1], "baseColorTexture": {"index": 0, "texCoord": 0,
            "extensions": {"KHR_texture_transform": {"offset": [0, 1], "rotation": 1, "scale": [2, 2]}}}},
        "normalTexture": {"index": 0, "scale": 1}, "extensions": {"KHR_materials_ior": {"ior": 1.4},
            "KHR_materials_transmission": {"transmissionFactor": 0.5}}}])");
    file.document["extensionsUsed"] = {"KHR_lights_punctual", "KHR_texture_transform"};
    return file;
}

}  // namespace limpid::scene::test
