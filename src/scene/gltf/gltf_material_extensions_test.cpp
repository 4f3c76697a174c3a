// Tests KHR_materials_anisotropy, _clearcoat, _diffuse_transmission, _dispersion, _sheen, _specular and
// _volume in the loader.
#include <cmath>
#include <limits>

#include "base/log.h"
#include "image/io/png/png.h"
#include "scene/load/loader_test_files.h"
#include "scene/prepare/prepare.h"

namespace limpid::scene::test {
namespace {

class MaterialExtensionsTest : public FolderTest {
  protected:
    MaterialExtensionsTest() {
        image::writePng(folder / "a.png", {1, 1, 4, {1, 2, 3, 4}});
        file.add("images", {{"uri", "a.png"}});
        file.add("textures", {{"source", 0}});
        file.document["extensionsUsed"] =
            file.document["extensionsRequired"] = {"KHR_materials_clearcoat",
                                                   "KHR_materials_specular",
                                                   "KHR_materials_volume",
                                                   "KHR_materials_transmission",
                                                   "KHR_materials_anisotropy",
                                                   "KHR_materials_dispersion",
                                                   "KHR_materials_diffuse_transmission",
                                                   "KHR_materials_sheen",
                                                   "KHR_materials_iridescence"};
    }

    Material load(const std::string& extensions) {
        file.document["materials"] = json::array({{{"extensions", json::parse(extensions)}}});
        file.primitive()["material"] = 0;
        scene = loadScene(file.save(folder));
        return scene.materials.at(0);
    }

    const Texture& texture(const TextureRef& ref) const {
        return scene.textures.at(static_cast<size_t>(ref.texture));
    }

    GltfFile file = square();
    Scene scene;
};

TEST_F(MaterialExtensionsTest, Clearcoat) {
    const Material m =
        load(R"({"KHR_materials_clearcoat": {"clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.5,
        "clearcoatTexture": {"index": 0}, "clearcoatRoughnessTexture": {"index": 0},
        "clearcoatNormalTexture": {"index": 0, "scale": 0.5}}})");
    EXPECT_EQ(m.clearcoat, 0.75f);
    EXPECT_EQ(m.clearcoatRoughness, 0.5f);
    EXPECT_EQ(m.clearcoatNormalScale, 0.5f);
    ASSERT_TRUE(m.clearcoatTexture && m.clearcoatRoughnessTexture && m.clearcoatNormalTexture);
    EXPECT_FALSE(texture(m.clearcoatTexture).srgb);
    EXPECT_FALSE(m.normalTexture);
    log::setLevel(log::Level::Error);
    prepare(scene);
    log::setLevel(log::Level::Info);
    EXPECT_EQ(scene.meshes[0].tangents.size(), scene.meshes[0].positions.size())
        << "the coat's normal map needs them";
}

TEST_F(MaterialExtensionsTest, Anisotropy) {
    const Material m =
        load(R"({"KHR_materials_anisotropy": {"anisotropyStrength": 0.6, "anisotropyRotation": 1.5,
        "anisotropyTexture": {"index": 0}}})");
    EXPECT_EQ(m.anisotropy, 0.6f);
    EXPECT_EQ(m.anisotropyRotation, 1.5f);
    ASSERT_TRUE(m.anisotropyTexture);
    EXPECT_FALSE(texture(m.anisotropyTexture).srgb);
    log::setLevel(log::Level::Error);
    prepare(scene);
    log::setLevel(log::Level::Info);
    EXPECT_EQ(scene.meshes[0].tangents.size(), scene.meshes[0].positions.size())
        << "its direction needs them";
}

TEST_F(MaterialExtensionsTest, Sheen) {
    const Material m = load(R"({"KHR_materials_sheen": {"sheenColorFactor": [0.1, 0.2, 0.3],
        "sheenRoughnessFactor": 0.4, "sheenColorTexture": {"index": 0}, "sheenRoughnessTexture": {"index": 0}}})");
    EXPECT_EQ(m.sheenColor, vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.sheenRoughness, 0.4f);
    ASSERT_TRUE(m.sheenColorTexture && m.sheenRoughnessTexture);
    EXPECT_TRUE(texture(m.sheenColorTexture).srgb);
}

TEST_F(MaterialExtensionsTest, Iridescence) {
    const Material m = load(R"({"KHR_materials_iridescence": {"iridescenceFactor": 0.5, "iridescenceIor": 1.8,
        "iridescenceThicknessMinimum": 200, "iridescenceThicknessMaximum": 900, "iridescenceTexture": {"index": 0},
        "iridescenceThicknessTexture": {"index": 0}}})");
    EXPECT_EQ(m.iridescence, 0.5f);
    EXPECT_EQ(m.iridescenceIor, 1.8f);
    EXPECT_EQ(m.iridescenceThicknessMin, 200.0f);
    EXPECT_EQ(m.iridescenceThicknessMax, 900.0f);
    ASSERT_TRUE(m.iridescenceTexture && m.iridescenceThicknessTexture);
    EXPECT_FALSE(texture(m.iridescenceTexture).srgb);
}

TEST_F(MaterialExtensionsTest, DiffuseTransmissionAndDispersion) {
    const Material m = load(R"({"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.25,
        "diffuseTransmissionColorFactor": [1, 0.9, 0.8], "diffuseTransmissionTexture": {"index": 0},
        "diffuseTransmissionColorTexture": {"index": 0}}, "KHR_materials_dispersion": {"dispersion": 0.36}})");
    EXPECT_EQ(m.diffuseTransmission, 0.25f);
    EXPECT_EQ(m.diffuseTransmissionColor, vec3(1.0f, 0.9f, 0.8f));
    ASSERT_TRUE(m.diffuseTransmissionTexture && m.diffuseTransmissionColorTexture);
    EXPECT_TRUE(texture(m.diffuseTransmissionColorTexture).srgb);
    EXPECT_EQ(m.dispersion, 0.36f);
}

TEST_F(MaterialExtensionsTest, DefaultsSwitchThemOff) {
    const Material m = load(R"({"KHR_materials_clearcoat": {"clearcoatTexture": {"index": 0}},
        "KHR_materials_specular": {"specularFactor": 0, "specularTexture": {"index": 0}},
        "KHR_materials_volume": {"attenuationColor": [0.5, 0.5, 0.5]},
        "KHR_materials_anisotropy": {"anisotropyTexture": {"index": 0}}, "KHR_materials_dispersion": {},
        "KHR_materials_sheen": {"sheenRoughnessFactor": 1, "sheenColorTexture": {"index": 0}},
        "KHR_materials_diffuse_transmission": {"diffuseTransmissionTexture": {"index": 0}}})");
    EXPECT_EQ(m.anisotropy, 0.0f);
    EXPECT_EQ(m.sheenColor, vec3(0.0f));
    EXPECT_EQ(m.diffuseTransmission, 0.0f);
    EXPECT_EQ(m.dispersion, 0.0f);
    EXPECT_EQ(m.clearcoat, 0.0f);
    EXPECT_EQ(m.clearcoatRoughness, 0.0f);
    EXPECT_EQ(m.absorption, vec3(0.0f)) << "the distance is infinite";
    EXPECT_TRUE(m.thin) << "the thickness is 0";
    EXPECT_TRUE(scene.textures.empty()) << "what nothing needs is not loaded";
}

TEST_F(MaterialExtensionsTest, SpecularTextures) {
    const Material m = load(R"({"KHR_materials_specular": {"specularTexture": {"index": 0},
        "specularColorTexture": {"index": 0}, "specularColorFactor": [0.5, 1, 2]}})");
    EXPECT_EQ(m.specularColor, vec3(0.5f, 1, 2));
    ASSERT_TRUE(m.specularTexture && m.specularColorTexture);
    EXPECT_FALSE(texture(m.specularTexture).srgb);
    EXPECT_TRUE(texture(m.specularColorTexture).srgb);
}

TEST_F(MaterialExtensionsTest, Volume) {
    const Material m =
        load(R"({"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume":
        {"thicknessFactor": 0.25, "attenuationDistance": 0.5, "attenuationColor": [0.25, 1, 0]}})");
    EXPECT_FALSE(m.thin);
    // Transmission c after the distance d: sigma = -log(c) / d.
    EXPECT_NEAR(std::exp(-0.5f * m.absorption.r), 0.25f, 1e-6f);
    EXPECT_EQ(m.absorption.g, 0.0f);
    EXPECT_TRUE(std::isfinite(m.absorption.b));
    EXPECT_LT(std::exp(-0.5f * m.absorption.b), 1e-20f);
}

TEST_F(MaterialExtensionsTest, ValuesOutOfRange) {
    log::setLevel(log::Level::Error);
    const Material m =
        load(R"({"KHR_materials_clearcoat": {"clearcoatFactor": 3, "clearcoatRoughnessFactor": -1},
        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 1e-40, "attenuationColor": [2, -1, 0.5]}})");
    EXPECT_EQ(m.clearcoat, 1.0f);
    EXPECT_EQ(m.clearcoatRoughness, 0.0f);
    const Material more = load(R"({"KHR_materials_anisotropy": {"anisotropyStrength": 2},
        "KHR_materials_sheen": {"sheenColorFactor": [2, -1, 0.5], "sheenRoughnessFactor": 7},
        "KHR_materials_dispersion": {"dispersion": -1}})");
    EXPECT_EQ(more.anisotropy, 1.0f);
    EXPECT_EQ(more.sheenColor, vec3(1.0f, 0.0f, 0.5f));
    EXPECT_EQ(more.sheenRoughness, 1.0f);
    EXPECT_EQ(more.dispersion, 0.0f);
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(m.absorption[c] >= 0.0f && std::isfinite(m.absorption[c]));
    for (const char* distance : {"0", "-1"}) {
        const Material volume = load(std::string(R"({"KHR_materials_volume": {"thicknessFactor": 1,
            "attenuationColor": [0.1, 0.1, 0.1], "attenuationDistance": )") +
                                     distance + "}}");
        EXPECT_EQ(volume.absorption, vec3(0.0f));
    }
    for (const char* bad :
         {R"({"KHR_materials_clearcoat": {"clearcoatFactor": "x"}})", R"({"KHR_materials_clearcoat": 1})",
          R"({"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": {"index": 7}}})",
          R"({"KHR_materials_volume": {"attenuationColor": [1, 1]}})",
          R"({"KHR_materials_sheen": {"sheenColorFactor": [1, 1]}})",
          R"({"KHR_materials_anisotropy": {"anisotropyStrength": []}})",
          R"({"KHR_materials_specular": {"specularColorTexture": {}}})"}) {
        EXPECT_THROW(load(bad), InputError) << bad;
    }
    log::setLevel(log::Level::Info);
}

}  // namespace
}  // namespace limpid::scene::test
