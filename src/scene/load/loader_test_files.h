// For the loaders' tests: creates scene files in a temporary folder.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "scene/load/load.h"

namespace limpid::scene::test {

namespace fs = std::filesystem;
using nlohmann::json;

inline void put(const fs::path& path, const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
}

inline std::string get(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// A fixture with an empty folder, which is removed afterwards.
class FolderTest : public testing::Test {
  protected:
    FolderTest() {
        std::string pattern = (fs::temp_directory_path() / "limpid_scene_test.XXXXXX").string();
        folder = ::mkdtemp(pattern.data());
    }
    ~FolderTest() override { fs::remove_all(folder); }
    fs::path folder;
};

/// Returns the folder with the shared scenes; none (and a message) if the checkout has none.
inline std::optional<fs::path> sharedScenes() {
    const fs::path scenes = fs::path(LIMPID_SOURCE_DIR) / ".." / "shared" / "scenes";
    if (fs::is_directory(scenes)) return scenes;
    std::cerr << "\n***** NOT TESTED: no scenes at ../shared/scenes beside the source tree *****\n\n";
    return std::nullopt;
}

/// A glTF document under construction: JSON, and one binary buffer.
struct GltfFile {
    json document = json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                                    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {}}]}],
                                    "accessors": [], "bufferViews": []})");
    std::string bytes;

    json& primitive() { return document["meshes"][0]["primitives"][0]; }

    /// Appends to a list of the document and returns the new element's index.
    int add(const char* list, json element) {
        document[list].push_back(std::move(element));
        return static_cast<int>(document[list].size()) - 1;
    }

    int addView(const void* data, size_t size) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        const size_t offset = bytes.size();
        bytes.append(static_cast<const char*>(data), size);
        return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
    }

    template <typename T>
    int addAccessor(const std::vector<T>& values, const char* type, size_t components, int componentType) {
        const int view = addView(values.data(), values.size() * sizeof(T));
        return add("accessors", {{"bufferView", view},
                                 {"componentType", componentType},
                                 {"count", values.size() / components},
                                 {"type", type}});
    }
    int addFloats(const std::vector<float>& values, const char* type, size_t components) {
        return addAccessor(values, type, components, 5126);
    }

    void finishBuffer(const char* uri) {
        json buffer = {{"byteLength", bytes.size()}};
        if (uri) buffer["uri"] = uri;
        document["buffers"] = json::array({buffer});
    }

    /// Writes name.gltf with name.bin beside it.
    fs::path save(const fs::path& folder, const std::string& name = "scene") {
        finishBuffer((name + ".bin").c_str());
        put(folder / (name + ".bin"), bytes);
        put(folder / (name + ".gltf"), document.dump());
        return folder / (name + ".gltf");
    }

    std::string glb() {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        finishBuffer(nullptr);
        std::string text = document.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const auto word = [](size_t value) {
            const auto number = static_cast<uint32_t>(value);
            std::string four(4, '\0');
            std::memcpy(four.data(), &number, 4);
            return four;
        };
        return "glTF" + word(2) + word(28 + text.size() + bytes.size()) + word(text.size()) + "JSON" + text +
               word(bytes.size()) + std::string("BIN\0", 4) + bytes;
    }
};

template <typename T>
inline constexpr int componentType = sizeof(T) == 1 ? (std::is_signed_v<T> ? 5120 : 5121)
                                                    : (std::is_signed_v<T> ? 5122 : 5123);

/// Adds an accessor of `values`. Each element is padded to a multiple of four bytes with non-zero bytes.
template <typename T>
int addPadded(GltfFile& file, const std::vector<T>& values, const char* type, size_t components,
              bool normalized) {
    const size_t stride = (components * sizeof(T) + 3) / 4 * 4;
    std::string bytes(values.size() / components * stride, '\x5a');
    for (size_t i = 0; i < values.size(); i += components)
        std::memcpy(bytes.data() + i / components * stride, &values[i], components * sizeof(T));
    const int view = file.addView(bytes.data(), bytes.size());
    file.document["bufferViews"].back()["byteStride"] = stride;
    return file.add("accessors", {{"bufferView", view},
                                  {"componentType", componentType<T>},
                                  {"count", values.size() / components},
                                  {"type", type},
                                  {"normalized", normalized}});
}

/// One triangle, counter-clockwise in the XY plane, without indices.
inline GltfFile triangle() {
    GltfFile file;
    file.primitive()["attributes"]["POSITION"] = file.addFloats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
    return file;
}

/// A unit square of two triangles with normals, texture coordinates and 16-bit indices.
inline GltfFile square() {
    GltfFile file;
    json& attributes = file.primitive()["attributes"];
    attributes["POSITION"] = file.addFloats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 3);
    attributes["NORMAL"] = file.addFloats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    attributes["TEXCOORD_0"] = file.addFloats({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 2);
    file.primitive()["indices"] = file.addAccessor<uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR", 1, 5123);
    return file;
}

/// Returns a TGA of 24 bits, rows from bottom to top. `pixels` are blue, green, red.
inline std::string tgaOf(uint8_t width, uint8_t height, const std::vector<uint8_t>& pixels) {
    std::string text(18, '\0');
    text[2] = 2;
    text[12] = static_cast<char>(width);
    text[14] = static_cast<char>(height);
    text[16] = 24;
    return text + std::string(pixels.begin(), pixels.end());
}

/// Loads a scene with a minor fault, and expects a warning that contains `fault`.
inline Scene loadWarned(const fs::path& path, const std::string& fault, const LoadOptions& options = {}) {
    log::setLevel(log::Level::Info);
    testing::internal::CaptureStderr();
    Scene scene;
    try {
        scene = loadScene(path, options);
    } catch (const Error& error) {
        ADD_FAILURE() << "refused: " << error.what();
    }
    const std::string messages = testing::internal::GetCapturedStderr();
    EXPECT_NE(messages.find(fault), std::string::npos) << "expected '" << fault << "' in: " << messages;
    return scene;
}

/// Expects that loading fails as for bad input: exit code 3, and a message with the file's name and `fault`.
inline void expectRefused(const fs::path& path, const std::string& fault) {
    try {
        loadScene(path);
        FAIL() << path << " was accepted; expected: " << fault;
    } catch (const Error& error) {
        const std::string message = error.what();
        EXPECT_EQ(error.code(), ExitCode::BadInput) << message;
        EXPECT_NE(message.find(path.stem().string()), std::string::npos) << message;
        EXPECT_NE(message.find(fault), std::string::npos) << "expected '" << fault << "' in: " << message;
    }
}

}  // namespace limpid::scene::test
