// Tests that the Scene contains what OBJ and MTL files describe. obj_bad_input_test.cpp tests malformed
// files.
#include <gmock/gmock.h>

#include <cmath>

#include "image/io/png/png.h"
#include "scene/load/loader_test_files.h"
#include "scene/load/validate.h"
#include "scene/obj/obj_polygon.h"

namespace limpid::scene::test {
namespace {

class ObjTest : public FolderTest {
  protected:
    Scene load(const std::string& obj, const std::string& mtl = {}) {
        if (!mtl.empty()) put(folder / "scene.mtl", mtl);
        put(folder / "scene.obj", (mtl.empty() ? "" : "mtllib scene.mtl\n") + obj);
        return loadScene(folder / "scene.obj");
    }
    /// Returns the material "m" of an MTL file with these statements.
    Material material(const std::string& statements, const std::string& name = "m") {
        return load(corners + "usemtl " + name + "\nf 1 2 3\n", "newmtl " + name + "\n" + statements)
            .materials.at(0);
    }
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
};

TEST(SharedObj, LoadWithTheirTriangles) {
    const auto scenes = sharedScenes();
    if (!scenes) GTEST_SKIP() << "the shared scenes are missing";
    EXPECT_EQ(loadScene(*scenes / "cornell_box_obj/cornell_box.obj").triangleCount(), 36u);
    EXPECT_EQ(loadScene(*scenes / "cornell_suzanne_obj/cornellbox_suzanne.obj").triangleCount(), 980u);
    const Scene scene = loadScene(*scenes / "cornell_box_obj/cornell_box_multimaterial.obj");
    EXPECT_EQ(scene.triangleCount(), 36u);
    float emission = 0.0f;
    for (const Material& material : scene.materials) emission = std::max(emission, material.emission.x);
    EXPECT_EQ(emission, 20.0f) << "Ka of the material 'light'";
}

TEST_F(ObjTest, ReadsFacesWithAllKindsOfCorners) {
    const Scene scene = load(
        corners +
        "vt 0.25 0.75\nvn 0 0 2\nf 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 -3/-1/-1 3/1/1 4/1/1\n");
    ASSERT_EQ(scene.meshes.size(), 1u);
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.triangleCount(), 5u);
    EXPECT_EQ(mesh.uv0.back(), vec2(0.25f, 0.25f)) << "v points down";
    EXPECT_THAT(mesh.normals, testing::Each(vec3(0, 0, 1)));
    EXPECT_EQ(findFault(scene), std::nullopt);
}

TEST_F(ObjTest, SharesVerticesAndSkipsWhatItDoesNotDraw) {
    put(folder / "scene.obj", corners + "vp 1 2\ns 1\nl 1 2 3\np 1\nf 1 2 3 # comment\nf 1 3 \\\n 4\n");
    const Scene scene =
        loadWarned(folder / "scene.obj", "points, lines, curves and surfaces are not drawn: 2");
    EXPECT_EQ(scene.meshes.at(0).positions.size(), 4u);
    EXPECT_THAT(scene.meshes[0].indices, testing::ElementsAre(0, 1, 2, 0, 2, 3));
    EXPECT_TRUE(scene.meshes[0].normals.empty());
}

TEST_F(ObjTest, GroupsBecomeMeshesWithMaterialSlots) {
    const Scene scene =
        load(corners + "o one\nusemtl b\nf 1 2 3\nusemtl c\nf 1 3 4\no empty\no two\nf 1 2 4\n",
             "newmtl a\nnewmtl b\nKd 0.1 0.2 0.3\nnewmtl c\n");
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_THAT(scene.meshes[0].materialSlots, testing::ElementsAre(0, 1));
    EXPECT_EQ(scene.instances[0].material, 1);
    EXPECT_EQ(scene.instances[0].name, "one");
    EXPECT_TRUE(scene.meshes[1].materialSlots.empty());
    EXPECT_EQ(scene.instances[1].material, 2);
    EXPECT_EQ(scene.materials[1].baseColor, vec4(0.1f, 0.2f, 0.3f, 1.0f));
}

TEST_F(ObjTest, ReadsVertexColors) {
    const Scene scene = load("v 0 0 0\nv 1 0 0 1 0 0\nv 0 1 0 0 1 0\nf 1 2 3\n");
    EXPECT_THAT(scene.meshes.at(0).colors, testing::ElementsAre(vec4(1), vec4(1, 0, 0, 1), vec4(0, 1, 0, 1)));
}

TEST_F(ObjTest, MissingMaterialsAreGrey) {
    for (const char* text : {"", "mtllib none.mtl\nusemtl x\n", "usemtl y\n"}) {
        const Scene scene = load(text + corners + "f 1 2 3\n");
        EXPECT_EQ(scene.materials.at(0).specular, 0.0f);
        EXPECT_EQ(scene.materials.at(0).baseColor, vec4(0.8f, 0.8f, 0.8f, 1.0f));
    }
}

TEST_F(ObjTest, PhongBecomesMetallicRoughness) {
    const Material diffuse = material("Kd 0.5 0.6 0.7\nKs 0 0 0\n");
    EXPECT_EQ(diffuse.specular, 0.0f);
    EXPECT_EQ(diffuse.metallic, 0.0f);
    EXPECT_TRUE(diffuse.doubleSided);
    const Material glossy = material("Kd 0.5\nKs 0.2 0.4 0.1\nNs 30\nNi 1.4\n");
    EXPECT_EQ(glossy.baseColor, vec4(0.5f, 0.5f, 0.5f, 1.0f));
    EXPECT_EQ(glossy.specular, 0.4f);
    EXPECT_FLOAT_EQ(glossy.roughness, 0.5f) << "(2 / 32)^(1/4)";
    EXPECT_EQ(glossy.ior, 1.4f);
    const Material mirror = material("Kd 0 0 0\nKs 0.9 0.8 0.7\nillum 5\n");
    EXPECT_EQ(mirror.metallic, 1.0f);
    EXPECT_EQ(mirror.roughness, 0.0f);
    EXPECT_EQ(mirror.baseColor, vec4(0.9f, 0.8f, 0.7f, 1.0f));
    const Material glass = material("Kd 1 1 1\nillum 7\nNi 1.6\n");
    EXPECT_EQ(glass.transmission, 1.0f);
    EXPECT_FALSE(glass.thin);
    EXPECT_EQ(glass.ior, 1.6f);
}

TEST_F(ObjTest, EmissionAndAlpha) {
    EXPECT_EQ(material("Ke 3 2 1\n").emission, vec3(3, 2, 1));
    EXPECT_EQ(material("Ka 5 5 5\n", "areaLIGHT").emission, vec3(5.0f));
    EXPECT_EQ(material("Ka 5 5 5\nKe 0 0 0\n", "light").emission, vec3(0.0f));
    EXPECT_EQ(material("Ka 5 5 5\n", "wall").emission, vec3(0.0f));
    EXPECT_EQ(material("d 0.25\n").alphaMode, AlphaMode::Blend);
    EXPECT_EQ(material("Tr 0.25\n").baseColor.a, 0.75f);
    EXPECT_EQ(material("d 1\n").alphaMode, AlphaMode::Opaque);
}

TEST_F(ObjTest, ReadsMaps) {
    image::writePng(folder / "my picture.png", {1, 1, 3, {1, 2, 3}});
    const Scene scene =
        load(corners + "usemtl m\nf 1 2 3\n",
             "newmtl m\nKd 0 0 0\nmap_Kd -s 2 3 -o 0.5 -clamp on my picture.png\nnorm my picture.png\n");
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.baseColor, vec4(1.0f));
    ASSERT_TRUE(m.baseColorTexture && m.normalTexture);
    EXPECT_TRUE(scene.textures[static_cast<size_t>(m.baseColorTexture.texture)].srgb);
    EXPECT_EQ(scene.textures[static_cast<size_t>(m.baseColorTexture.texture)].sampler.wrapU,
              Wrap::ClampToEdge);
    EXPECT_FALSE(scene.textures[static_cast<size_t>(m.normalTexture.texture)].srgb);
    // v = 1 - v' of the file: 0 is 1 in the file, which is scaled to 3, which is -2 from the top
    EXPECT_EQ(m.baseColorTexture.rowU, vec3(2, 0, 0.5f));
    EXPECT_EQ(m.baseColorTexture.rowV, vec3(0, 3, -2));
    const fs::path in = fs::canonical(folder);
    EXPECT_THAT(scene.files,
                testing::IsSupersetOf({folder / "scene.obj", in / "scene.mtl", in / "my picture.png"}));
}

/// Two by two pixels: red, green above blue, white; rows from bottom to top, as in TGA and BMP.
const std::vector<uint8_t> fourColors = {255, 0, 0, 255, 255, 255, 0, 0, 255, 0, 255, 0};

std::string bmpOfFourColors() {
    std::string text("BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x02\0\0\0\x02\0\0\0\x01\0\x18\0", 30);
    text.resize(54);
    for (size_t row = 0; row < 2; ++row) {
        text.append(fourColors.begin() + static_cast<std::ptrdiff_t>(row * 6),
                    fourColors.begin() + static_cast<std::ptrdiff_t>(row * 6 + 6));
        text.append(2, '\0');
    }
    return text;
}

TEST_F(ObjTest, ReadsTgaAndBmp) {
    std::string runs = tgaOf(2, 2, {});
    runs[2] = 10;
    runs += std::string("\x00\xff\x00\x00\x80\xff\xff\xff\x01\x00\x00\xff\x00\xff\x00", 15);
    put(folder / "a.tga", tgaOf(2, 2, fourColors));
    put(folder / "runs.tga", runs);
    put(folder / "a.bmp", bmpOfFourColors());
    const std::vector<uint8_t> expected = {255, 0, 0,   255, 0,   255, 0,   255,
                                           0,   0, 255, 255, 255, 255, 255, 255};
    for (const char* name : {"a.tga", "runs.tga", "a.bmp"}) {
        const Scene scene =
            load(corners + "usemtl m\nf 1 2 3\n", "newmtl m\nmap_Kd " + std::string(name) + "\n");
        ASSERT_EQ(scene.textures.size(), 1u) << name;
        EXPECT_EQ(scene.textures[0].rgba, expected) << name;
    }
}

TEST_F(ObjTest, TexturesThatCannotBeHadAreWarnedOfAndPlain) {
    const auto expectPlain = [&](const std::string& file, const std::string& fault) {
        put(folder / "scene.mtl", "newmtl m\nKd 0.1 0.2 0.3\nmap_Kd " + file + "\nmap_Ke " + file + "\n");
        put(folder / "scene.obj", "mtllib scene.mtl\nusemtl m\n" + corners + "f 1 2 3\n");
        const Scene scene = loadWarned(folder / "scene.obj", fault);
        EXPECT_TRUE(scene.textures.empty());
        EXPECT_EQ(scene.materials.at(0).baseColor, vec4(0.1f, 0.2f, 0.3f, 1.0f));
        EXPECT_EQ(scene.materials[0].emission, vec3(0.0f)) << "the factor alone would glow all over";
    };
    expectPlain("none.png", "scene.obj: refers to 'none.png', which does not exist; a plain colour is used");
    expectPlain("C:\\textures\\wood.png", "relative");
    expectPlain("/etc/passwd", "'/etc/passwd', which is an absolute path");
    expectPlain("../none.png", "lies outside the scene's folder");
    put(folder / "text.png", "this is no picture");
    expectPlain("text.png", "text.png: is none of PNG, JPEG, TGA and BMP");
    put(folder / "cut.tga", tgaOf(2, 2, {1, 2, 3}));
    expectPlain("cut.tga", "cut.tga: is a TGA file that was cut off");
    put(folder / "cut.bmp", bmpOfFourColors().substr(0, 60));
    expectPlain("cut.bmp", "cut.bmp: is a BMP file that was cut off");
    fs::create_directory(folder / "folder.png");
    expectPlain("folder.png", "is a directory");
}

TEST_F(ObjTest, ABlackColourUnderAMissingTextureIsGrey) {
    EXPECT_EQ(material("Kd 0 0 0\nmap_Kd none.png\n").baseColor, vec4(0.8f, 0.8f, 0.8f, 1.0f));
    EXPECT_EQ(material("map_Kd none.png\n").baseColor, vec4(0.8f, 0.8f, 0.8f, 1.0f));
}

TEST_F(ObjTest, MaterialFilesThatCannotBeHadAreWarnedOf) {
    for (const auto& [name, fault] :
         {std::pair{"none.mtl", "scene.obj: line 1: there is no material file 'none.mtl'"},
          std::pair{"/etc/none.mtl", "'/etc/none.mtl', which is an absolute path"},
          std::pair{"../none.mtl", "'../none.mtl', which lies outside the scene's folder"},
          std::pair{"folder.mtl", "there is no material file 'folder.mtl'"}}) {
        fs::create_directories(folder / "folder.mtl");
        put(folder / "scene.obj", "mtllib " + std::string(name) + "\nusemtl m\n" + corners + "f 1 2 3\n");
        EXPECT_EQ(loadWarned(folder / "scene.obj", fault).materials.at(0).name, "grey");
    }
}

TEST_F(ObjTest, TexturesBesideTheSceneFolderAreReadWithinTheAssetRoot) {
    fs::create_directories(folder / "models");
    fs::create_directories(folder / "textures");
    image::writePng(folder / "textures" / "wood.png", {1, 1, 3, {1, 2, 3}});
    fs::create_directory_symlink("../textures", folder / "models" / "tex");
    put(folder / "models" / "a.mtl", "newmtl m\nmap_Kd ../textures/wood.png\nnorm tex/wood.png\n");
    put(folder / "models" / "a.obj", "mtllib a.mtl\nusemtl m\n" + corners + "f 1 2 3\n");
    const fs::path file = folder / "models" / "a.obj";
    const Scene whole = loadScene(file, {.assetRoot = defaultAssetRoot(file)});
    EXPECT_TRUE(whole.materials.at(0).baseColorTexture && whole.materials[0].normalTexture);
    const Scene alone = loadWarned(file, "lies outside the scene's folder");
    EXPECT_FALSE(alone.materials.at(0).baseColorTexture || alone.materials[0].normalTexture);
}

float areaOf(const std::vector<vec3>& corners, const std::array<uint32_t, 3>& t) {
    return 0.5f * glm::cross(corners[t[1]] - corners[t[0]], corners[t[2]] - corners[t[0]]).z;
}

TEST(Triangulate, CoversConcavePolygonsExactly) {
    const std::vector<std::vector<vec3>> polygons = {
        {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0.5f, 0}},                                           // a dart
        {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}},  // a U
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-0.5f, 0.5f, 0}},
    };
    for (const auto& polygon : polygons) {
        float whole = 0.0f;
        for (size_t i = 0; i < polygon.size(); ++i) {
            const vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            whole += 0.5f * (a.x * b.y - a.y * b.x);
        }
        const auto triangles = triangulate(polygon);
        EXPECT_EQ(triangles.size(), polygon.size() - 2);
        float sum = 0.0f;
        for (const auto& t : triangles) {
            EXPECT_GE(areaOf(polygon, t), 0.0f);
            sum += areaOf(polygon, t);
        }
        EXPECT_NEAR(sum, whole, 1e-5f);
    }
}

}  // namespace
}  // namespace limpid::scene::test
