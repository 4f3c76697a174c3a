// Tests that the Scene contains what a glTF file describes. gltf_bad_input_test.cpp tests malformed files.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "image/io/png/png.h"
#include "scene/load/loader_test_files.h"
#include "scene/load/scene_files.h"
#include "scene/load/validate.h"
#include "scene/prepare/mesh_repair.h"

namespace limpid::scene::test {
namespace {

using GltfTest = FolderTest;

// --- the shared scenes
// ------------------------------------------------------------------------------------------

struct SharedFile {
    const char* path;
    size_t triangles;
};

class SharedGltf : public testing::TestWithParam<SharedFile> {};

TEST_P(SharedGltf, LoadsWithItsTriangles) {
    const auto scenes = sharedScenes();
    if (!scenes) GTEST_SKIP() << "the shared scenes are missing";
    const Scene scene = loadScene(*scenes / GetParam().path);
    EXPECT_EQ(scene.triangleCount(), GetParam().triangles);
    EXPECT_EQ(findFault(scene), std::nullopt);
}

INSTANTIATE_TEST_SUITE_P(
    Files, SharedGltf,
    testing::Values(SharedFile{"cornell_box_glb/CornellBox.glb", 36},
                    SharedFile{"painting_neon/scene.gltf", 43714}, SharedFile{"neon_sign/love.glb", 46552},
                    SharedFile{"emissive_strength_test/EmissiveStrengthTest.gltf", 90},
                    SharedFile{"stained_glass_lamp/StainedGlassLamp.gltf", 35132},
                    SharedFile{"lights_punctual_lamp/LightsPunctualLamp.gltf", 6000},
                    SharedFile{"hotel_room/hotel_room.glb", 99029},
                    SharedFile{"low_poly_jungle/scene.gltf", 18515},
                    SharedFile{"flight_helmet/FlightHelmet.gltf", 94722},
                    SharedFile{"metal_rough_spheres/MetalRoughSpheresNoTextures.gltf", 1040409},
                    SharedFile{"transmission_test/TransmissionTest.glb", 128775},
                    SharedFile{"alpha_blend_mode_test/AlphaBlendModeTest.gltf", 61},
                    SharedFile{"normal_tangent_mirror_test/NormalTangentMirrorTest.glb", 5240},
                    SharedFile{"texture_settings_test/TextureSettingsTest.glb", 72},
                    SharedFile{"vertex_color_test/VertexColorTest.glb", 36},
                    SharedFile{"box_animated/BoxAnimated.gltf", 254},
                    SharedFile{"cesium_man/CesiumMan.gltf", 4672},
                    SharedFile{"morph_cube/AnimatedMorphCube.gltf", 12}),
    [](const auto& param) {
        const std::string path = param.param.path;
        return path.substr(0, path.find('/'));
    });

TEST(SharedGltfDetails, MeshesThatShareAccessorsAreStoredOnce) {
    const auto scenes = sharedScenes();
    if (!scenes) GTEST_SKIP() << "the shared scenes are missing";
    const Scene scene = loadScene(*scenes / "metal_rough_spheres/MetalRoughSpheresNoTextures.gltf");
    size_t vertices = 0;
    for (const Mesh& mesh : scene.meshes) vertices += mesh.positions.size();
    EXPECT_LT(vertices, 10'000u);
    EXPECT_GE(scene.materials.size(), 98u);
}

TEST(SharedGltfDetails, SkinnedFigureStandsUpright) {
    const auto scenes = sharedScenes();
    if (!scenes) GTEST_SKIP() << "the shared scenes are missing";
    const Scene scene = loadScene(*scenes / "cesium_man/CesiumMan.gltf");
    vec3 lower(1e9f), upper(-1e9f);
    for (const vec3& p : scene.meshes.at(0).positions) {
        const vec3 world = vec3(scene.instances.at(0).transform * vec4(p, 1.0f));
        lower = glm::min(lower, world);
        upper = glm::max(upper, world);
    }
    EXPECT_NEAR(lower.y, 0.0f, 0.05f);
    EXPECT_NEAR(upper.y, 1.5f, 0.1f);
    EXPECT_LT(upper.x - lower.x, 1.3f);
    EXPECT_LT(upper.z - lower.z, 1.3f);
}

TEST(SharedGltfDetails, LightsCamerasAndEmissionAsTheReadmeSays) {
    const auto scenes = sharedScenes();
    if (!scenes) GTEST_SKIP() << "the shared scenes are missing";
    EXPECT_EQ(loadScene(*scenes / "lights_punctual_lamp/LightsPunctualLamp.gltf").lights.size(), 5u);
    EXPECT_EQ(loadScene(*scenes / "transmission_test/TransmissionTest.glb").cameras.size(), 1u);
    const Scene cornell = loadScene(*scenes / "cornell_box_glb/CornellBox.glb");
    const auto brightest =
        std::max_element(cornell.materials.begin(), cornell.materials.end(),
                         [](const Material& a, const Material& b) { return a.emission.x < b.emission.x; });
    EXPECT_FLOAT_EQ(brightest->emission.x, 100.0f);
}

// --- geometry
// ---------------------------------------------------------------------------------------------------

TEST_F(GltfTest, LoadsTheSameFromFilesAndFromGlb) {
    GltfFile file = square();
    put(folder / "scene.glb", file.glb());
    for (const fs::path& path : {file.save(folder), folder / "scene.glb"}) {
        const Scene scene = loadScene(path);
        ASSERT_EQ(scene.meshes.size(), 1u);
        const Mesh& mesh = scene.meshes[0];
        EXPECT_THAT(mesh.indices, testing::ElementsAre(0, 1, 2, 0, 2, 3));
        EXPECT_EQ(mesh.positions[2], vec3(1, 1, 0));
        EXPECT_EQ(mesh.normals[0], vec3(0, 0, 1));
        EXPECT_EQ(mesh.uv0[1], vec2(1, 1));
        EXPECT_EQ(scene.materials.size(), 1u);
        EXPECT_TRUE(scene.cameras.empty());
    }
}

TEST_F(GltfTest, ReadsDataUrisAndPercentEncodedNames) {
    GltfFile file = triangle();
    fs::path path = file.save(folder, "with space");
    file.document["buffers"][0]["uri"] = "with%20space.bin";
    put(path, file.document.dump());
    EXPECT_EQ(loadScene(path).triangleCount(), 1u);
    EXPECT_THAT(loadScene(path).files, testing::ElementsAre(path, fs::canonical(folder) / "with space.bin"));
    file.document["buffers"][0] = {
        {"byteLength", 36},
        {"uri", "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}};
    put(path, file.document.dump());
    EXPECT_EQ(loadScene(path).meshes[0].positions[1], vec3(1, 0, 0));
    EXPECT_EQ(decodePercent("%41%zz%4"), "A%zz%4");
}

TEST_F(GltfTest, ReadsEveryIndexType) {
    for (const int type : {5121, 5123, 5125}) {
        GltfFile file = triangle();
        file.primitive()["indices"] = type == 5121 ? file.addAccessor<uint8_t>({2, 1, 0}, "SCALAR", 1, type)
                                      : type == 5123
                                          ? file.addAccessor<uint16_t>({2, 1, 0}, "SCALAR", 1, type)
                                          : file.addAccessor<uint32_t>({2, 1, 0}, "SCALAR", 1, type);
        EXPECT_THAT(loadScene(file.save(folder)).meshes[0].indices, testing::ElementsAre(2, 1, 0)) << type;
    }
}

TEST_F(GltfTest, TurnsStripsAndFansIntoTrianglesOfOneOrientation) {
    GltfFile file;
    file.primitive()["attributes"]["POSITION"] =
        file.addFloats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, "VEC3", 3);
    file.primitive()["mode"] = 5;
    EXPECT_THAT(loadScene(file.save(folder)).meshes[0].indices,
                testing::ElementsAre(0, 1, 2, 1, 3, 2, 2, 3, 4));
    file.primitive()["mode"] = 6;
    EXPECT_THAT(loadScene(file.save(folder)).meshes[0].indices,
                testing::ElementsAre(1, 2, 0, 2, 3, 0, 3, 4, 0));
}

TEST_F(GltfTest, SkipsPointsAndLines) {
    GltfFile file = triangle();
    json points = file.primitive();
    points["mode"] = 0;
    file.document["meshes"][0]["primitives"].push_back(points);
    EXPECT_EQ(loadScene(file.save(folder)).instances.size(), 1u);
    file.primitive()["mode"] = 1;
    expectRefused(file.save(folder), "no triangles");
}

TEST_F(GltfTest, NodesShareTheDrawnPrimitivesOfAMesh) {
    GltfFile file = square();
    json& primitives = file.document["meshes"][0]["primitives"];
    json points = primitives[0], fan = primitives[0];
    points["mode"] = 0;
    fan["mode"] = 6;
    primitives = {points, primitives[0], points, fan};
    file.document["nodes"] = json::array({{{"mesh", 0}}, {{"mesh", 0}}});
    file.document["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = loadScene(file.save(folder));
    ASSERT_EQ(scene.instances.size(), 4u);
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.meshes[0].name, "meshes[0].1");
    EXPECT_EQ(scene.meshes[1].name, "meshes[0].3");
    EXPECT_EQ(scene.instances[2].mesh, 0);
    EXPECT_EQ(scene.instances[3].node, 1);
}

TEST_F(GltfTest, ReadsInterleavedAttributes) {
    GltfFile file;
    const float data[] = {0, 0, 0, /**/ 9, 9, 1, 0, 0, /**/ 8, 8, 0, 1, 0, /**/ 7, 7};
    const int view = file.addView(data, sizeof data);
    file.document["bufferViews"][static_cast<size_t>(view)]["byteStride"] = 20;
    json& attributes = file.primitive()["attributes"];
    attributes["POSITION"] = file.add(
        "accessors", {{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    attributes["TEXCOORD_0"] = file.add(
        "accessors",
        {{"bufferView", view}, {"byteOffset", 12}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}});
    const Scene scene = loadScene(file.save(folder));
    EXPECT_EQ(scene.meshes[0].positions[2], vec3(0, 1, 0));
    EXPECT_EQ(scene.meshes[0].uv0[2], vec2(7, 7));
}

TEST_F(GltfTest, FillsInSparseAccessors) {
    GltfFile file = triangle();
    const uint8_t where[] = {1};
    const float values[] = {5, 6, 7};
    const int indices = file.addView(where, sizeof where);
    const int replaced = file.addView(values, sizeof values);
    json& accessor = file.document["accessors"][0];
    accessor["sparse"] = {{"count", 1},
                          {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                          {"values", {{"bufferView", replaced}}}};
    EXPECT_THAT(loadScene(file.save(folder)).meshes[0].positions,
                testing::ElementsAre(vec3(0, 0, 0), vec3(5, 6, 7), vec3(0, 1, 0)));
    accessor.erase("bufferView");  // zeros
    EXPECT_THAT(loadScene(file.save(folder)).meshes[0].positions,
                testing::ElementsAre(vec3(0), vec3(5, 6, 7), vec3(0)));
}

TEST_F(GltfTest, ConvertsNormalizedIntegers) {
    GltfFile file = triangle();
    json& attributes = file.primitive()["attributes"];
    attributes["COLOR_0"] =
        file.addAccessor<uint8_t>({255, 0, 51, 0, 0, 255, 0, 0, 0, 0, 0, 0}, "VEC4", 4, 5121);
    file.document["accessors"].back()["normalized"] = true;
    attributes["TEXCOORD_0"] = file.addAccessor<uint16_t>({65535, 0, 0, 0, 0, 0}, "VEC2", 2, 5123);
    file.document["accessors"].back()["normalized"] = true;
    attributes["NORMAL"] = file.addAccessor<int8_t>({-128, 0, 0, 0, 127, 0, 0, 0, 127}, "VEC3", 3, 5120);
    file.document["accessors"].back()["normalized"] = true;
    const Mesh mesh = loadScene(file.save(folder)).meshes[0];
    EXPECT_EQ(mesh.colors[0], vec4(1, 0, 0.2f, 0));
    EXPECT_EQ(mesh.uv0[0], vec2(1, 0));
    EXPECT_THAT(mesh.normals, testing::ElementsAre(vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)));
}

TEST_F(GltfTest, ThreeComponentColorsAreOpaque) {
    GltfFile file = triangle();
    file.primitive()["attributes"]["COLOR_0"] = file.addFloats({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3", 3);
    EXPECT_EQ(loadScene(file.save(folder)).meshes[0].colors[1], vec4(0, 1, 0, 1));
}

TEST_F(GltfTest, RepairsNormals) {
    GltfFile file = triangle();
    file.primitive()["attributes"]["NORMAL"] = file.addFloats({0, 0, 3, 0, 0, 0, NAN, 0, 1}, "VEC3", 3);
    EXPECT_THAT(loadScene(file.save(folder)).meshes[0].normals, testing::Each(vec3(0, 0, 1)));
}

TEST_F(GltfTest, PrimitivesWithTheSameAccessorsShareAMesh) {
    GltfFile file = square();
    file.add("materials", {{"name", "a"}});
    file.add("materials", {{"name", "b"}});
    json other = file.document["meshes"][0];
    other["primitives"][0]["material"] = 1;
    file.primitive()["material"] = 0;
    file.add("meshes", other);
    file.add("nodes", {{"mesh", 1}});
    file.document["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = loadScene(file.save(folder));
    EXPECT_EQ(scene.meshes.size(), 1u);
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.materials[static_cast<size_t>(scene.instances[0].material)].name, "a");
    EXPECT_EQ(scene.materials[static_cast<size_t>(scene.instances[1].material)].name, "b");
}

// --- nodes
// ------------------------------------------------------------------------------------------------------

TEST_F(GltfTest, ComposesTransformsDownTheHierarchy) {
    GltfFile file = triangle();
    file.document["nodes"] = json::parse(R"([
        {"children": [1], "translation": [1, 2, 3]},
        {"children": [2], "rotation": [0, 0, 0.70710678, 0.70710678]},
        {"mesh": 0, "matrix": [2,0,0,0, 0,-2,0,0, 0,0,2,0, 1,0,0,1]}])");
    const Scene scene = loadScene(file.save(folder));
    ASSERT_EQ(scene.instances.size(), 1u);
    const mat4& m = scene.instances[0].transform;
    // (0, 1, 0) -> scaled (0,-2,0) -> moved (1,-2,0) -> turned by 90 degrees about z (2,1,0) -> moved (3,3,3)
    EXPECT_LT(glm::distance(vec3(m * vec4(0, 1, 0, 1)), vec3(3, 3, 3)), 1e-5f);
    EXPECT_LT(glm::determinant(mat3(m)), 0.0f);
}

TEST_F(GltfTest, ShowsTheDefaultSceneOnly) {
    GltfFile file = triangle();
    file.document["nodes"] = json::parse(R"([{"mesh": 0, "name": "first"}, {"mesh": 0, "name": "second"}])");
    file.document["scenes"] = json::parse(R"([{"nodes": [0]}, {"nodes": [1]}])");
    file.document["scene"] = 1;
    Scene scene = loadScene(file.save(folder));
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.instances[0].name, "second");
    file.document.erase("scene");
    scene = loadScene(file.save(folder));
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.instances[0].name, "first");
    file.document.erase("scenes");
    EXPECT_EQ(loadScene(file.save(folder)).instances.size(), 2u);
}

TEST_F(GltfTest, AcceptsAVeryDeepTree) {
    GltfFile file = triangle();
    json nodes = json::array();
    for (int i = 1; i < 100'000; ++i) nodes.push_back({{"children", {i}}});
    nodes.push_back({{"mesh", 0}});
    file.document["nodes"] = nodes;
    EXPECT_EQ(loadScene(file.save(folder)).triangleCount(), 1u);
}

TEST_F(GltfTest, BakesTransformsWithoutInverseAndDropsCollapsedOnes) {
    GltfFile file = triangle();
    file.document["nodes"] =
        json::parse(R"([{"mesh": 0, "scale": [2, 3, 0]}, {"mesh": 0, "scale": [0, 0, 0]}])");
    file.document["scenes"][0]["nodes"] = {0, 1};
    const Scene scene = loadScene(file.save(folder));
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.instances[0].transform, mat4(1.0f));
    EXPECT_EQ(scene.meshes[static_cast<size_t>(scene.instances[0].mesh)].positions[2], vec3(0, 3, 0));
}

TEST_F(GltfTest, AppliesMorphWeightsAndJoints) {
    GltfFile file = triangle();
    json& primitive = file.primitive();
    primitive["targets"] =
        json::array({{{"POSITION", file.addFloats({0, 0, 4, 0, 0, 4, 0, 0, 4}, "VEC3", 3)}}});
    file.document["meshes"][0]["weights"] = {0.5};
    EXPECT_EQ(loadScene(file.save(folder)).meshes[0].positions[1], vec3(1, 0, 2));
    file.document["nodes"][0]["weights"] = {0.25};
    EXPECT_EQ(loadScene(file.save(folder)).meshes[0].positions[1], vec3(1, 0, 1));

    primitive["attributes"]["JOINTS_0"] =
        file.addAccessor<uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4", 4, 5121);
    primitive["attributes"]["WEIGHTS_0"] =
        file.addFloats({1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4", 4);
    file.document["nodes"] = json::parse(R"([{"mesh": 0, "skin": 0, "translation": [100, 0, 0]},
                                             {"translation": [0, 10, 0]}, {"translation": [0, 20, 0]}])");
    file.document["scenes"][0]["nodes"] = {0, 1, 2};
    file.document["skins"] = json::parse(R"([{"joints": [1, 2]}])");
    const Scene scene = loadScene(file.save(folder));
    EXPECT_THAT(scene.meshes[0].positions,
                testing::ElementsAre(vec3(0, 10, 2), vec3(1, 20, 2), vec3(0, 16, 2)));
    EXPECT_EQ(scene.instances[0].transform, mat4(1.0f));
}

// --- cameras, lights
// --------------------------------------------------------------------------------------------

TEST_F(GltfTest, ReadsCamerasWithoutTheirNodesScale) {
    GltfFile file = triangle();
    file.document["cameras"] =
        json::parse(R"([{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}},
        {"type": "orthographic", "name": "ortho", "orthographic": {"xmag": 4, "ymag": 2, "znear": 0, "zfar": 9}}])");
    file.document["nodes"] =
        json::parse(R"([{"mesh": 0}, {"name": "eye", "camera": 0, "translation": [0, 0, 5],
        "scale": [3, -3, 3]}, {"camera": 1}])");
    file.document["scenes"][0]["nodes"] = {0, 1, 2};
    const Scene scene = loadScene(file.save(folder));
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].name, "eye");
    EXPECT_FLOAT_EQ(scene.cameras[0].verticalFov, 0.9f);
    EXPECT_EQ(scene.cameras[0].aspect, 0.0f);
    EXPECT_NEAR(glm::determinant(mat3(scene.cameras[0].toWorld)), 1.0f, 1e-5f);
    EXPECT_EQ(vec3(scene.cameras[0].toWorld[3]), vec3(0, 0, 5));
    EXPECT_TRUE(scene.cameras[1].orthographic);
    EXPECT_EQ(scene.cameras[1].name, "ortho");
    EXPECT_EQ(scene.cameras[1].halfHeight, 2.0f);
    EXPECT_EQ(scene.cameras[1].aspect, 2.0f);
}

TEST_F(GltfTest, ReadsPunctualLights) {
    GltfFile file = triangle();
    file.document["extensionsUsed"] = {"KHR_lights_punctual"};
    file.document["extensions"]["KHR_lights_punctual"]["lights"] = json::parse(R"([
        {"type": "point", "color": [1, 0.5, 0], "intensity": 40, "range": 7},
        {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}},
        {"type": "directional", "intensity": 3}])");
    file.document["nodes"] = json::parse(R"([{"mesh": 0, "children": [1, 2, 3]},
        {"translation": [1, 2, 3], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"extensions": {"KHR_lights_punctual": {"light": 1}}, "rotation": [-0.70710678, 0, 0, 0.70710678]},
        {"extensions": {"KHR_lights_punctual": {"light": 2}}}])");
    const Scene scene = loadScene(file.save(folder));
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].intensity, vec3(40, 20, 0));
    EXPECT_EQ(scene.lights[0].position, vec3(1, 2, 3));
    EXPECT_EQ(scene.lights[0].range, 7.0f);
    EXPECT_EQ(scene.lights[1].kind, PunctualLight::Kind::Spot);
    EXPECT_LT(glm::distance(scene.lights[1].direction, vec3(0, -1, 0)), 1e-5f);
    EXPECT_FLOAT_EQ(scene.lights[1].outerCone, 0.2f);
    EXPECT_EQ(scene.lights[2].kind, PunctualLight::Kind::Directional);
    EXPECT_EQ(scene.lights[2].direction, vec3(0, 0, -1));
}

// --- materials, textures
// ----------------------------------------------------------------------------------------

class GltfMaterialTest : public FolderTest {
  protected:
    Material load(const char* material) {
        file.document["materials"] = json::array({json::parse(material)});
        file.primitive()["material"] = 0;
        scene = loadScene(file.save(folder));
        return scene.materials.at(0);
    }
    void addImage(const std::string& name, uint8_t value) {
        image::writePng(folder / name, {2, 1, 3, {value, 2, 3, 4, 5, 6}});
        file.add("images", {{"uri", name}});
    }
    GltfFile file = square();
    Scene scene;
};

TEST_F(GltfMaterialTest, DefaultsAreGltfs) {
    const Material m = load("{}");
    EXPECT_EQ(m.baseColor, vec4(1.0f));
    EXPECT_EQ(m.metallic, 1.0f);
    EXPECT_EQ(m.roughness, 1.0f);
    EXPECT_EQ(m.emission, vec3(0.0f));
    EXPECT_EQ(m.ior, 1.5f);
    EXPECT_EQ(m.alphaMode, AlphaMode::Opaque);
    EXPECT_FALSE(m.doubleSided);
}

TEST_F(GltfMaterialTest, ReadsFactorsAndExtensions) {
    const Material m = load(R"({"name": "m", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25,
        "emissiveFactor": [1, 0.5, 0],
        "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 10},
            "KHR_materials_transmission": {"transmissionFactor": 0.7}, "KHR_materials_ior": {"ior": 1.33},
            "KHR_materials_specular": {"specularFactor": 0.8}, "KHR_materials_unlit": {}}})");
    EXPECT_EQ(m.name, "m");
    EXPECT_EQ(m.baseColor, vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_EQ(m.metallic, 0.5f);
    EXPECT_EQ(m.roughness, 0.6f);
    EXPECT_EQ(m.emission, vec3(10, 5, 0));
    EXPECT_EQ(m.transmission, 0.7f);
    EXPECT_TRUE(m.thin);
    EXPECT_EQ(m.ior, 1.33f);
    EXPECT_EQ(m.specular, 0.8f);
    EXPECT_TRUE(m.unlit);
    EXPECT_TRUE(m.doubleSided);
    EXPECT_EQ(m.alphaMode, AlphaMode::Mask);
    EXPECT_EQ(m.alphaCutoff, 0.25f);
}

TEST_F(GltfMaterialTest, AVolumeIsNotThin) {
    EXPECT_FALSE(load(R"({"extensions": {"KHR_materials_volume": {"thicknessFactor": 0.1}}})").thin);
    EXPECT_TRUE(load(R"({"extensions": {"KHR_materials_volume": {}}})").thin);
}

TEST_F(GltfMaterialTest, KeepsAnEmissiveFactorAboveOneAndClampsTheRest) {
    const Material m = load(R"({"emissiveFactor": [3, 0, 0],
        "pbrMetallicRoughness": {"baseColorFactor": [2, -1, 0, 1], "roughnessFactor": 1.5}})");
    EXPECT_EQ(m.emission, vec3(3, 0, 0));
    EXPECT_EQ(m.baseColor, vec4(1, 0, 0, 1));
    EXPECT_EQ(m.roughness, 1.0f);
}

TEST_F(GltfMaterialTest, TexturesAreDistinctByImageEncodingAndSampler) {
    addImage("a.png", 1);
    file.document["samplers"] =
        json::parse(R"([{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9729}])");
    file.document["textures"] =
        json::parse(R"([{"source": 0}, {"source": 0}, {"source": 0, "sampler": 0}, {"name": "unused"}])");
    const Material m = load(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
            "metallicRoughnessTexture": {"index": 0}}, "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 1},
        "normalTexture": {"index": 2, "scale": 0.5}, "occlusionTexture": {"index": 1, "strength": 0.25}})");
    ASSERT_EQ(scene.textures.size(), 3u) << "sRGB, linear, linear with another sampler";
    EXPECT_EQ(m.baseColorTexture.texture, m.emissionTexture.texture);
    EXPECT_EQ(m.metallicRoughnessTexture.texture, m.occlusionTexture.texture);
    EXPECT_NE(m.baseColorTexture.texture, m.metallicRoughnessTexture.texture);
    EXPECT_EQ(m.normalScale, 0.5f);
    EXPECT_EQ(m.occlusionStrength, 0.25f);
    const Texture& color = scene.textures[static_cast<size_t>(m.baseColorTexture.texture)];
    EXPECT_TRUE(color.srgb);
    EXPECT_EQ(color.sampler, Sampler{});
    EXPECT_THAT(color.rgba, testing::ElementsAre(1, 2, 3, 255, 4, 5, 6, 255));
    const Texture& normal = scene.textures[static_cast<size_t>(m.normalTexture.texture)];
    EXPECT_FALSE(normal.srgb);
    EXPECT_EQ(normal.sampler,
              (Sampler{Wrap::ClampToEdge, Wrap::MirroredRepeat, false, true, MipFilter::None}));
}

TEST_F(GltfMaterialTest, ReadsImagesFromBufferViews) {
    addImage("a.png", 7);
    const std::string png = get(folder / "a.png");
    const int view = file.addView(png.data(), png.size());
    file.document["images"][0] = {{"bufferView", view}, {"mimeType", "image/png"}};
    file.document["textures"] = json::parse(R"([{"source": 0}])");
    load(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})");
    EXPECT_EQ(scene.textures.at(0).rgba[0], 7);
}

TEST_F(GltfMaterialTest, ReadsTextureTransforms) {
    addImage("a.png", 1);
    file.document["textures"] = json::parse(R"([{"source": 0}])");
    const Material m =
        load(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 0, "extensions":
        {"KHR_texture_transform": {"offset": [0.25, 0.5], "scale": [2, 4], "rotation": 1.57079632679, "texCoord": 1}}}}})");
    EXPECT_EQ(m.baseColorTexture.uvSet, 1);
    const auto apply = [&](const vec3& uv) {
        return vec2(glm::dot(m.baseColorTexture.rowU, uv), glm::dot(m.baseColorTexture.rowV, uv));
    };
    // Scaled to (2, 0), then turned counter-clockwise as seen with v downwards: (0, -2); then moved.
    EXPECT_LT(glm::distance(apply(vec3(1, 0, 1)), vec2(0.25f, -1.5f)), 1e-5f);
    EXPECT_LT(glm::distance(apply(vec3(0, 1, 1)), vec2(4.25f, 0.5f)), 1e-5f);
}

}  // namespace
}  // namespace limpid::scene::test
