// Tests malformed glTF documents and GLB files (model/bad_input_test.cpp).
#include <cstring>
#include <limits>

#include "scene/load/bad_input_test.h"

namespace limpid::scene::test {
namespace {

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

TEST_F(BadInput, MorphTargetsAreCountedBeforeTheyAreRead) {
    GltfFile file = triangle();
    const int zeros = file.add("accessors", {{"componentType", 5126}, {"count", 4096}, {"type", "VEC3"}});
    file.primitive()["attributes"]["POSITION"] = zeros;
    const json target = {{"POSITION", zeros}};
    file.primitive()["targets"] = json(40'000, target);
    expectRefused(file.save(folder), "vertices or triangles");
}

TEST_F(BadInput, MorphWeightsOfManyNodesAreBounded) {
    GltfFile file = triangle();
    file.document["meshes"][0]["weights"] = json(100'000, 0);
    for (int i = 1; i < 200; ++i) file.add("nodes", {{"mesh", 0}});
    file.document.erase("scenes");
    file.document.erase("scene");
    expectRefused(file.save(folder), "too many morph weights");
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

}  // namespace
}  // namespace limpid::scene::test
