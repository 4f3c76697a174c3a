// Tests malformed scene files: each is rejected with its name and fault, in bounded time and memory. Run with
// sanitizers (LIMPID_SANITIZE) to detect out-of-bounds accesses.
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "base/log.h"
#include "image/io/png/png.h"
#include "scene/model/environment.h"
#include "scene/model/loader_test_files.h"
#include "scene/model/prepare.h"
#include "scene/model/scene_files.h"

namespace limpid::scene::test {
namespace {

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

json parse(const char* text) {
    return json::parse(text);
}

/// A document that uses most features of the loader, so that mutations reach them.
GltfFile richFile(const fs::path& folder) {
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

// --- files
// ------------------------------------------------------------------------------------------------------

TEST_F(BadInput, WhatIsNoSceneFileAtAll) {
    for (const char* name : {"none.gltf", "none.glb", "none.obj"})
        expectRefused(folder / name, "does not exist");
    for (const char* name : {"empty.gltf", "empty.glb", "empty.obj"})
        expectRefused(write(name, ""), "is empty");
    for (const char* name : {"folder.gltf", "folder.obj"}) {
        fs::create_directory(folder / name);
        expectRefused(folder / name, "is a directory");
    }
    expectRefused(write("scene.fbx", "x"), "no scene format");
    expectRefused(write("scene", "x"), "no scene format");
    expectRefused(write("scene.gltf", "{"), "not valid JSON");
    expectRefused(write("scene.gltf", "[]"), "no object");
    expectRefused(write("scene.gltf", "{}"), "asset");
    expectRefused(write("scene.gltf", R"({"asset": {"version": "1.0"}})"), "version");
    expectRefused(write("scene.gltf", "\xff\xfe"), "begins with ff fe, as UTF-16 text does");
    expectRefused(write("scene.glb", "GLTF\x02"),
                  "is neither GLB nor a glTF document: it begins with 47 4c 54 46");
    expectRefused(write("scene.glb", "PK\x03\x04"), "as a ZIP archive does");
    expectRefused(write("scene.gltf", "version https://git-lfs.github.com/spec/v1\n"), "a Git LFS pointer");
    expectRefused(write("scene.gltf", R"({"asset": {"version": "2.0"}})"), "no triangles");
    expectRefused(write("scene.gltf", R"({"asset": {"version": 2}})"), "asset.version: is not a text");
}

TEST_F(BadInput, MissingOrShortBuffersAndImages) {
    GltfFile file = triangle();
    const fs::path path = file.save(folder);
    fs::remove(folder / "scene.bin");
    expectRefused(path, "'scene.bin', which does not exist");
    put(folder / "scene.bin", "short");
    expectRefused(path, "buffers[0]: has 5 bytes of the 36");
    fs::remove(folder / "scene.bin");
    fs::create_directory(folder / "scene.bin");
    expectRefused(path, "is a directory");
    fs::remove(folder / "scene.bin");

    GltfFile rich = richFile(folder);
    expectFault(rich, "images[0]: has neither",
                [](GltfFile& f) { f.document["images"][0] = json::object(); });
}

TEST_F(BadInput, ImagesThatCannotBeHadAreNamedAndPlain) {
    const auto expectPlain = [&](const std::string& fault, const std::function<void(GltfFile&)>& change) {
        GltfFile file = richFile(folder);
        change(file);
        const fs::path path = file.save(folder);
        const Scene scene = loadWarned(path, fault);
        EXPECT_TRUE(scene.textures.empty());
        EXPECT_FALSE(scene.materials.at(0).baseColorTexture || scene.materials[0].normalTexture);
    };
    const auto expectUri = [&](const std::string& uri, const std::string& fault) {
        expectPlain(fault, [&](GltfFile& f) { f.document["images"][0]["uri"] = uri; });
    };
    expectUri("none.png", "scene.gltf: refers to 'none.png', which does not exist");
    expectUri("../none.png", "'../none.png', which lies outside the scene's folder");
    expectUri("/etc/passwd", "absolute");
    expectUri("http://localhost/a.png", "relative");
    expectUri("data:image/png;base64,$$", "base64");
    expectUri("data:image/png,$$", "base64");
    expectPlain("has no image", [](GltfFile& f) { f.document["textures"][0].erase("source"); });
    const auto expectContent = [&](const std::string& content) {
        expectPlain("a.png", [&](GltfFile&) { put(folder / "a.png", content); });
    };
    richFile(folder);
    const std::string png = get(folder / "a.png");
    expectContent("");
    expectContent("this is no image");
    expectContent(png.substr(0, png.size() / 2));
    std::string huge = png;
    huge[16] = huge[20] = '\x7f';  // 2 billion pixels wide and high
    expectContent(huge);
    // glTF does not support TGA.
    expectContent(tgaOf(1, 1, {1, 2, 3}));
}

TEST_F(BadInput, AnEmissiveImageThatCannotBeHadSwitchesTheEmissionOff) {
    GltfFile file = richFile(folder);
    file.document["materials"][0]["emissiveTexture"] = {{"index", 0}};
    EXPECT_EQ(loadScene(file.save(folder)).materials.at(0).emission, vec3(1.0f));
    fs::remove(folder / "a.png");
    EXPECT_EQ(loadWarned(file.save(folder), "a.png").materials.at(0).emission, vec3(0.0f));
}

TEST_F(BadInput, BuffersThatLeaveTheFolder) {
    const fs::path inner = folder / "inner";
    fs::create_directory(inner);
    const std::string bytes(36, '\0');
    put(folder / "outside.bin", bytes);
    put(inner / "inside.bin", bytes);
    fs::create_symlink(folder / "outside.bin", inner / "link.bin");
    fs::create_directory_symlink(folder, inner / "up");
    const auto expectUri = [&](const std::string& uri, const std::string& fault) {
        GltfFile file = triangle();
        file.finishBuffer(uri.c_str());
        put(inner / "scene.gltf", file.document.dump());
        expectRefused(inner / "scene.gltf", fault);
    };
    const std::string absolute = (folder / "outside.bin").string();
    for (const char* uri : {"../outside.bin", "%2e%2e/outside.bin", "x/../../outside.bin", "..\\outside.bin",
                            "link.bin", "up/outside.bin"}) {
        expectUri(uri, "lies outside the scene's folder");
    }
    expectUri(absolute, "absolute");
    for (const std::string& uri :
         {"file://" + absolute, std::string("http://localhost/a.bin"), std::string("C:/a.bin")}) {
        expectUri(uri, "relative path");
    }
    expectUri("a%00.bin", "null character");
    expectUri("", "empty name");
    expectUri(".", "directory");
    expectUri(std::string(100'000, 'a'), "too long");

    const SceneFiles files(inner / "scene.gltf");
    EXPECT_NO_THROW(files.resolve("x/../inside.bin"));
    EXPECT_NO_THROW(files.resolve("./inside.bin"));
}

TEST_F(BadInput, TheAssetRootBoundsWhatMayBeRead) {
    const fs::path outer = folder / "outer", root = outer / "root", inner = root / "inner";
    fs::create_directories(inner);
    fs::create_directories(root / "textures");
    put(outer / "secret.bin", "x");
    put(root / "textures" / "wood.bin", "x");
    put(inner / "own.bin", "x");
    fs::create_directory_symlink("../textures", inner / "linked");
    fs::create_symlink(root / "textures" / "wood.bin", inner / "wood-link.bin");
    fs::create_symlink(outer / "secret.bin", inner / "secret-link.bin");
    fs::create_symlink("secret-link.bin", inner / "link-to-link.bin");
    const SceneFiles files(inner / "scene.obj", root);
    for (const char* name : {"own.bin", "../textures/wood.bin", "..\\textures\\wood.bin", "linked/wood.bin",
                             "wood-link.bin", "../inner/own.bin", "linked/../inner/own.bin"})
        EXPECT_TRUE(fs::is_regular_file(files.resolve(name))) << name;
    for (const char* name :
         {"../../secret.bin", "secret-link.bin", "link-to-link.bin", "linked/../../secret.bin",
          "../../root-beside/a.bin", "../..", "../../none/../secret.bin"}) {
        try {
            files.resolve(name);
            ADD_FAILURE() << name << " was accepted";
        } catch (const InputError& refusal) {
            EXPECT_NE(std::string(refusal.what()).find("outside the asset root"), std::string::npos)
                << refusal.what();
        }
    }
    // Files in the scene's own folder are allowed whatever the root is, and without a root only those.
    EXPECT_NO_THROW(SceneFiles(inner / "scene.obj", root / "textures").resolve("own.bin"));
    EXPECT_THROW(SceneFiles(inner / "scene.obj").resolve("linked/wood.bin"), InputError);
    EXPECT_THROW(SceneFiles(inner / "scene.obj", root / "none"), InputError);
    EXPECT_THROW(SceneFiles(inner / "scene.obj", inner / "own.bin"), InputError);
}

TEST_F(BadInput, TheDefaultAssetRootIsTheFolderAboveUnlessThatHoldsHomes) {
    const fs::path own = fs::canonical(folder);
    const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
    const auto rootWithHome = [&](const fs::path& value, const fs::path& scene) {
        ::setenv("HOME", value.c_str(), 1);
        return defaultAssetRoot(scene);
    };
    fs::create_directories(own / "homes" / "user" / "models");
    const fs::path scene = own / "homes" / "user" / "a.obj",
                   model = own / "homes" / "user" / "models" / "a.obj";
    EXPECT_EQ(rootWithHome("/elsewhere/user", scene), own / "homes");
    EXPECT_EQ(rootWithHome(own / "homes" / "user", scene), own / "homes" / "user") << "above are all homes";
    EXPECT_EQ(rootWithHome(own / "homes" / "user", model), own / "homes" / "user");
    EXPECT_EQ(rootWithHome(own / "homes" / "deep" / "user", scene), own / "homes" / "user");
    EXPECT_EQ(rootWithHome("", "/a.obj"), "/");
    EXPECT_EQ(rootWithHome("", "/folder/a.obj"), "/folder");
    EXPECT_EQ(rootWithHome("", "/home/user/a.obj"), "/home/user");
    EXPECT_EQ(rootWithHome("", "/home/user/models/a.obj"), "/home/user");
    ::setenv("HOME", home.c_str(), 1);
}

TEST_F(BadInput, RelativeSceneNamesWork) {
    const fs::path before = fs::current_path();
    triangle().save(folder);
    fs::current_path(folder);
    EXPECT_EQ(loadScene("scene.gltf").triangleCount(), 1u);
    fs::current_path(before);
}

// --- GLB
// --------------------------------------------------------------------------------------------------------

TEST_F(BadInput, TruncatedGlb) {
    const std::string glb = square().glb();
    put(folder / "scene.glb", glb);
    ASSERT_NO_THROW(loadScene(folder / "scene.glb"));
    for (size_t part = 0; part < 64; ++part) {
        put(folder / "scene.glb", glb.substr(0, glb.size() * part / 64));
        EXPECT_THROW(loadScene(folder / "scene.glb"), InputError) << part;
    }
}

TEST_F(BadInput, GlbHeadersThatLie) {
    const std::string glb = square().glb();
    const auto expectHeader = [&](size_t at, uint32_t value, const std::string& fault) {
        std::string changed = glb;
        std::memcpy(changed.data() + at, &value, 4);
        expectRefused(write("scene.glb", changed), fault);
    };
    expectHeader(0, 0, "neither GLB nor a glTF document: it begins with 00 00 00 00");
    expectHeader(4, 1, "version");
    for (const uint32_t length : {0u, 11u, 19u}) expectHeader(8, length, "first GLB chunk");
    expectHeader(8, 100, "does not fit");
    for (const uint32_t length : {static_cast<uint32_t>(glb.size()) + 1, ~0u, 0x80000000u})
        expectHeader(8, length, "truncated");
    for (const uint32_t length : {0x7fffffffu, ~0u, static_cast<uint32_t>(glb.size())})
        expectHeader(12, length, "does not fit");
    expectHeader(12, 0, "");
    expectHeader(16, 0, "first GLB chunk");
}

// --- JSON
// -------------------------------------------------------------------------------------------------------

TEST_F(BadInput, DeeplyNestedJson) {
    expectRefused(write("scene.gltf", std::string(1'000'000, '[')), "levels deep");
    std::string nested = R"({"asset": {"version": "2.0"}, "extras": )";
    for (int i = 0; i < 100'000; ++i) nested += R"({"a":)";
    expectRefused(write("scene.gltf", nested), "levels deep");
}

TEST_F(BadInput, WrongTypes) {
    const GltfFile rich = richFile(folder);
    const char* lists[] = {"accessors", "bufferViews", "cameras", "images", "materials", "meshes",
                           "nodes",     "samplers",    "scenes",  "skins",  "textures",  "extensionsUsed"};
    for (const char* list : lists) {
        for (const char* wrong : {"3", "\"x\"", "{}", "[3]", "[[]]", "null"}) {
            expectFault(rich, list, [&](GltfFile& f) { f.document[list] = parse(wrong); });
        }
    }
    expectFault(rich, "bufferViews[0].buffer",
                [](GltfFile& f) { f.document["bufferViews"][0]["buffer"] = "x"; });
    expectFault(rich, "nodes[1].translation: has 2", [](GltfFile& f) {
        f.document["nodes"][1]["translation"] = {1, 2};
    });
    expectFault(rich, "nodes[1].translation: element 0", [](GltfFile& f) {
        f.document["nodes"][1]["translation"] = {"x", 2, 3};
    });
    expectFault(rich, "nodes[3].matrix", [](GltfFile& f) { f.document["nodes"][3]["matrix"] = 4; });
    expectFault(rich, "not affine", [](GltfFile& f) { f.document["nodes"][3]["matrix"][3] = 4; });
    expectFault(rich, "doubleSided", [](GltfFile& f) { f.document["materials"][0]["doubleSided"] = 1; });
    expectFault(rich, "alphaMode", [](GltfFile& f) { f.document["materials"][0]["alphaMode"] = "GLOW"; });
    expectFault(rich, "yfov", [](GltfFile& f) { f.document["cameras"][0]["perspective"]["yfov"] = 0; });
    expectFault(rich, "neither perspective",
                [](GltfFile& f) { f.document["cameras"][0]["type"] = "fisheye"; });
    expectFault(rich, "wrapS", [](GltfFile& f) { f.document["samplers"][0]["wrapS"] = 1; });
    expectFault(rich, "requires what is not supported: KHR_texture_basisu, X", [](GltfFile& f) {
        f.document["extensionsRequired"] = {"KHR_texture_basisu", "X"};
    });
    std::string text = richFile(folder).document.dump();
    expectRefused(write("scene.gltf", text.insert(1, R"("extras": 1e999, )")), "not valid JSON");
}

TEST_F(BadInput, IndicesOutOfRange) {
    const GltfFile rich = richFile(folder);
    const std::vector<json::json_pointer> places = {
        "/scene"_json_pointer,
        "/scenes/0/nodes/0"_json_pointer,
        "/nodes/0/mesh"_json_pointer,
        "/nodes/0/children/0"_json_pointer,
        "/nodes/1/camera"_json_pointer,
        "/nodes/2/skin"_json_pointer,
        "/nodes/2/extensions/KHR_lights_punctual/light"_json_pointer,
        "/meshes/0/primitives/0/indices"_json_pointer,
        "/meshes/0/primitives/0/material"_json_pointer,
        "/meshes/0/primitives/0/attributes/POSITION"_json_pointer,
        "/meshes/0/primitives/0/attributes/NORMAL"_json_pointer,
        "/meshes/0/primitives/0/attributes/JOINTS_0"_json_pointer,
        "/meshes/0/primitives/0/targets/0/POSITION"_json_pointer,
        "/accessors/0/bufferView"_json_pointer,
        "/accessors/0/sparse/indices/bufferView"_json_pointer,
        "/accessors/0/sparse/values/bufferView"_json_pointer,
        "/bufferViews/0/buffer"_json_pointer,
        "/skins/0/joints/0"_json_pointer,
        "/textures/0/source"_json_pointer,
        "/textures/0/sampler"_json_pointer,
        "/materials/0/normalTexture/index"_json_pointer,
    };
    ASSERT_NO_THROW(loadScene(richFile(folder).save(folder)));
    for (const auto& place : places) {
        for (const char* wrong : {"1000", "-1", "4294967296", "9007199254740993", "1.5", "\"0\"", "1e300"}) {
            SCOPED_TRACE(place.to_string() + " = " + wrong);
            expectFault(rich, place.back() == "0" ? "" : place.back(),
                        [&](GltfFile& f) { f.document[place] = parse(wrong); });
        }
    }
}

TEST_F(BadInput, AccessorsThatClaimTooMuch) {
    const GltfFile rich = richFile(folder);
    const auto accessor = [&](const char* key, const char* value, const std::string& fault) {
        SCOPED_TRACE(std::string(key) + " = " + value);
        expectFault(rich, fault, [&](GltfFile& f) { f.document["accessors"][0][key] = parse(value); });
    };
    accessor("count", "1099511627776", "accepted");
    accessor("count", "100000000", "not inside");
    accessor("count", "5", "not inside");
    accessor("count", "-4", "count");
    accessor("count", "3", "elements");
    accessor("byteOffset", "4", "not inside");
    accessor("byteOffset", "9007199254740992", "not inside");
    accessor("componentType", "5124", "componentType");
    accessor("componentType", "0", "componentType");
    accessor("componentType", "5125", "indices only");
    accessor("type", "\"VEC2\"", "components");
    accessor("type", "\"MAT4\"", "not inside");
    accessor("type", "\"VEC5\"", "type");
    const auto view = [&](const char* key, const char* value, const std::string& fault) {
        SCOPED_TRACE(std::string(key) + " = " + value);
        expectFault(rich, fault, [&](GltfFile& f) { f.document["bufferViews"][0][key] = parse(value); });
    };
    view("byteStride", "4", "less than an element");
    view("byteStride", "256", "byteStride");
    view("byteStride", "9007199254740992", "byteStride");
    view("byteStride", "-12", "byteStride");
    view("byteStride", "16", "not inside");
    view("byteLength", "9007199254740992", "not inside its buffer");
    view("byteOffset", "9007199254740992", "not inside its buffer");
    view("byteOffset", "-4", "byteOffset");
    expectFault(rich, "byteLength", [](GltfFile& f) { f.document["bufferViews"][0].erase("byteLength"); });
    expectFault(triangle(), "too many", [](GltfFile& f) {
        f.document["accessors"][0].erase("bufferView");
        f.document["accessors"][0]["count"] = 100'000'000;
    });
    expectFault(rich, "more than the accessor's",
                [](GltfFile& f) { f.document["accessors"][0]["sparse"]["count"] = 5; });
    expectFault(rich, "no buffer view",
                [](GltfFile& f) { f.document["accessors"][0]["sparse"]["values"].erase("bufferView"); });
}

TEST_F(BadInput, ManyAccessorsOfNothingAreBoundedTogether) {
    GltfFile file = triangle();
    file.document["accessors"] = json::array();
    json primitives = json::array();
    for (int i = 0; i < 100; ++i) {
        const int accessor =
            file.add("accessors", {{"componentType", 5126}, {"count", 2'000'000 - i}, {"type", "VEC3"}});
        const int index = file.add("accessors", {{"componentType", 5121}, {"count", 1}, {"type", "SCALAR"}});
        // One index makes no triangle, so the mesh is discarded immediately.
        primitives.push_back({{"attributes", {{"POSITION", accessor}}}, {"indices", index}});
    }
    file.document["meshes"][0]["primitives"] = primitives;
    expectRefused(file.save(folder), "too many for an accessor without data");
    // A document of two million bytes may have accessors of as many zeros, but not arbitrarily many.
    file.finishBuffer("scene.bin");
    expectRefused(write("scene.gltf", file.document.dump() + std::string(2'000'000, ' ')),
                  "vertices or triangles");
}

TEST_F(BadInput, BadGeometry) {
    GltfFile file = triangle();
    file.primitive()["indices"] = file.addAccessor<uint16_t>({0, 1, 3}, "SCALAR", 1, 5123);
    expectRefused(file.save(folder), "names vertex 3 of 3");
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        GltfFile nan = triangle();
        std::memcpy(nan.bytes.data() + 16, &bad, 4);
        expectRefused(nan.save(folder), "position of vertex 1 is not finite");
    }
    GltfFile joint = richFile(folder);
    joint.document["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] =
        joint.addAccessor<uint8_t>(std::vector<uint8_t>(16, 1), "VEC4", 4, 5121);
    expectRefused(joint.save(folder), "names joint 1 of 1");
    GltfFile far = triangle();
    far.document["nodes"][0]["scale"] = {1e30, 1e30, 1e30};
    expectRefused(far.save(folder), "too large");
    EXPECT_NO_THROW(loadScene(GltfFile([] {
                                  GltfFile flat = triangle();
                                  std::fill(flat.bytes.begin(), flat.bytes.end(), '\0');
                                  return flat;
                              }())
                                  .save(folder)))
        << "degenerate triangles are no fault";
}

TEST_F(BadInput, NodesThatAreNoTree) {
    const auto expectNodes = [&](const char* nodes, const std::string& fault) {
        expectFault(triangle(), fault, [&](GltfFile& f) { f.document["nodes"] = parse(nodes); });
    };
    expectNodes(R"([{"mesh": 0, "children": [0]}])", "its own ancestor");
    expectNodes(R"([{"mesh": 0}, {"children": [2]}, {"children": [1]}])", "its own ancestor");
    expectNodes(R"([{"children": [1, 2]}, {"children": [3]}, {"children": [3]}, {"mesh": 0}])",
                "already has the parent");
    expectNodes(R"([{"children": [1, 1]}, {"mesh": 0}])", "already has the parent");
    GltfFile file = triangle();  // doubles at each level: 2^60 instances if it were allowed
    for (int i = 0; i < 60; ++i) file.add("nodes", {{"mesh", 0}, {"children", {i, i}}});
    file.document["scenes"][0]["nodes"] = {60};
    expectRefused(file.save(folder), "already has the parent");
    GltfFile many = triangle();  // a thousand nodes with a thousand primitives, and one more
    many.document["meshes"][0]["primitives"] = json(1025, many.primitive());
    for (int i = 1; i < 1025; ++i) many.add("nodes", {{"mesh", 0}});
    many.document.erase("scenes");
    many.document.erase("scene");
    expectRefused(many.save(folder), "too many");
}

// --- OBJ and HDR
// ------------------------------------------------------------------------------------------------

TEST_F(BadInput, Obj) {
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const auto expectObj = [&](const std::string& text, const std::string& fault) {
        SCOPED_TRACE(text.substr(0, 100));
        expectRefused(write("scene.obj", text), fault);
    };
    for (const char* index :
         {"4", "-4", "0", "99999999999999999999", "2147483648", "-2147483649", "nan", "1.5", "x", "/1"}) {
        expectObj(corners + "f 1 2 " + index + "\n", "line 4");
        expectObj(corners + "vt 0 0\nf 1/1 2/1 3/" + index + "\n", "line 5");
        expectObj(corners + "vn 0 0 1\nf 1//1 2//1 3//" + index + "\n", "line 5");
    }
    for (const char* number : {"nan", "inf", "-inf", "1e39", "1e999", "x", "1,5", ""}) {
        expectObj("v 0 0 0\nv 1 0 0\nv 0 1 " + std::string(number) + "\nf 1 2 3\n", "line 3");
    }
    expectObj("v 0 0 0\nv 1e20 0 0\nv 0 1e20 0\nf 1 2 3\n", "too large");
    expectObj(corners + "f 1 2\n", "fewer than three");
    expectObj(corners, "no triangles");
    expectObj("mtllib\n", "without a file name");
    expectObj(std::string(1000, '\0'), "NUL character");
    put(folder / "scene.mtl", "newmtl m\nKd 1 x 1\n");
    put(folder / "scene.obj", "mtllib scene.mtl\n" + corners + "usemtl m\nf 1 2 3\n");
    EXPECT_THROW(loadScene(folder / "scene.obj"), InputError);
}

TEST_F(BadInput, ObjThatIsNoText) {
    const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::string wide;
    for (const char c : text) wide += std::string(1, c) + '\0';
    expectRefused(write("a.obj", "\xff\xfe" + wide), "is UTF-16 text");
    expectRefused(write("a.obj", wide), "line 1: holds a NUL character");
    expectRefused(write("a.obj", text + std::string("# a\0b\n", 6)), "line 5: holds a NUL character");
    EXPECT_NO_THROW(loadScene(write("a.obj", "\xef\xbb\xbf" + text)))
        << "a byte order mark of UTF-8 is no fault";
}

TEST_F(BadInput, ObjAbuse) {
    std::string polygon = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
    for (int i = 0; i < 300'000; ++i) polygon += i % 3 == 0 ? " 1" : i % 3 == 1 ? " 2" : " 3";
    EXPECT_EQ(loadScene(write("scene.obj", polygon + "\n")).triangleCount(), 299'998u);
    std::string zigzag;  // star-shaped: the slow case of triangulation
    std::string face = "f";
    for (int i = 0; i < 256; ++i) {
        const float angle = static_cast<float>(i) * 2.0f * pi / 256.0f;
        const float radius = i % 2 ? 0.1f : 1.0f;
        zigzag += "v " + std::to_string(radius * std::cos(angle)) + " " +
                  std::to_string(radius * std::sin(angle)) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    for (int i = 0; i < 100; ++i) zigzag += face + "\n";
    EXPECT_EQ(loadScene(write("scene.obj", zigzag)).triangleCount(), 25'400u);
    std::string libraries = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < 10'000; ++i) libraries += "mtllib scene.mtl\nusemtl none" + std::to_string(i) + "\n";
    put(folder / "scene.mtl", "newmtl a\n" + std::string(1'000'000, '#'));
    EXPECT_EQ(loadScene(write("scene.obj", libraries + "f 1 2 3\n")).triangleCount(), 1u);
}

TEST_F(BadInput, Environments) {
    EXPECT_THROW(loadEnvironment(folder / "none.hdr"), InputError);
    EXPECT_THROW(loadEnvironment(folder), InputError);
    EXPECT_THROW(loadEnvironment(write("a.jpg", "x")), InputError);
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    for (const std::string& content :
         {std::string(), std::string("#?RADIANCE\n"), header, header + "-Y 2 +X 2\n",
          header + "-Y 2 +X 2\n1234", header + "-Y -2 +X 2\n", header + "-Y 1000000 +X 1000000\n1234",
          header + "-Y 99999999999 +X 1\n"}) {
        EXPECT_THROW(loadEnvironment(write("a.hdr", content)), InputError) << content;
        EXPECT_THROW(loadEnvironment(write("a.exr", content)), InputError) << content;
    }
}

// --- random damage
// ----------------------------------------------------------------------------------------------

/// Flips bits, and sometimes deletes or repeats a range of bytes.
std::string damaged(std::string content, std::mt19937& random) {
    const auto below = [&](size_t n) { return std::uniform_int_distribution<size_t>(0, n - 1)(random); };
    const size_t changes = 1 + below(4);
    for (size_t i = 0; i < changes && !content.empty(); ++i) {
        const size_t at = below(content.size());
        const size_t length = 1 + below(std::min<size_t>(32, content.size() - at));
        switch (below(6)) {
            case 0:
                content.erase(at, length);
                break;
            case 1:
                content.insert(at, content.substr(at, length));
                break;
            default:
                content[at] = static_cast<char>(content[at] ^ (1 << below(8)));
        }
    }
    return content;
}

TEST_F(BadInput, RandomBitFlips) {
    GltfFile file = richFile(folder);
    const std::string glb = file.glb();
    const std::string gltf = get(file.save(folder));
    const std::string bin = get(folder / "scene.bin");
    for (unsigned seed = 0; seed < 700; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        expectLoadsOrIsRefused(write("scene.glb", damaged(glb, random)));
        expectLoadsOrIsRefused(write("scene.gltf", damaged(gltf, random)));
        put(folder / "scene.gltf", gltf);
        expectLoadsOrIsRefused((write("scene.bin", damaged(bin, random)), folder / "scene.gltf"));
        put(folder / "scene.bin", bin);
    }
    EXPECT_GT(loaded, 100);
    EXPECT_GT(refused, 100);
}

TEST_F(BadInput, RandomValues) {
    const std::vector<json> values = {
        parse("-1"),   parse("0"),    parse("1"),        parse("2"),          parse("5121"),
        parse("5126"), parse("1e30"), parse("1e-40"),    parse("4294967295"), parse("1099511627776"),
        parse("null"), parse("true"), parse("\"VEC4\""), parse("[]"),         parse("{}"),
        parse("[0]"),  parse("0.5"),  parse("-1e300")};
    GltfFile file = richFile(folder);
    file.save(folder);
    const json flat = file.document.flatten();
    for (unsigned seed = 0; seed < 2000; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        const auto below = [&](size_t n) { return std::uniform_int_distribution<size_t>(0, n - 1)(random); };
        json changed = file.document;
        for (size_t i = 0, n = 1 + below(3); i < n; ++i) {
            const auto leaf = std::next(flat.begin(), static_cast<std::ptrdiff_t>(below(flat.size())));
            json::json_pointer place(leaf.key());
            // Sometimes change the container instead of the leaf.
            if (below(4) == 0) place = place.parent_pointer();
            if (changed.contains(place)) changed[place] = values[below(values.size())];
        }
        expectLoadsOrIsRefused(write("scene.gltf", changed.dump()));
    }
    EXPECT_GT(loaded, 100);
    EXPECT_GT(refused, 100);
}

TEST_F(BadInput, RandomObj) {
    const std::string obj =
        "mtllib scene.mtl\no a\nv 0 0 0\nv 1 0 0\nv 1 1 0 1 0 0\nv 0 1 0\nvt 0 1\nvn 0 0 1\nusemtl m\nf "
        "1/1/1 2/1/1 3/1/1 "
        "4/1/1\ng b\nusemtl n\nf -1 -2 -3\nf 1//1 2//1 3//1\n";
    const std::string mtl =
        "newmtl m\nKd 1 0.5 0\nKs 1 1 1\nNs 10\nillum 7\nmap_Kd -s 1 1 1 -o 0 0 -clamp on a.png\nnewmtl "
        "n\nKe 1 1 1\nd 0.5\n";
    image::writePng(folder / "a.png", {1, 1, 3, {1, 2, 3}});
    for (unsigned seed = 0; seed < 1000; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        put(folder / "scene.mtl", seed % 2 ? damaged(mtl, random) : mtl);
        expectLoadsOrIsRefused(write("scene.obj", seed % 2 ? obj : damaged(obj, random)));
    }
    EXPECT_GT(loaded, 100);
    EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace limpid::scene::test
