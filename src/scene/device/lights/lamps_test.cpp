// Tests which emissive triangles count as one lamp.
#include "scene/device/lights/lamps.h"

#include <gtest/gtest.h>

#include <bit>
#include <numeric>

#include "scene/builtin/mesh_builder.h"
#include "scene/device/scene_data.h"
#include "scene/lights/environment.h"

namespace limpid::scene {
namespace {

std::vector<uint32_t> allOf(const Mesh& mesh) {
    std::vector<uint32_t> triangles(mesh.triangleCount());
    std::iota(triangles.begin(), triangles.end(), 0u);
    return triangles;
}

/// A row of squares of width 1, `gap` apart.
Mesh row(int squares, float gap) {
    MeshBuilder builder("row");
    for (int i = 0; i < squares; ++i) {
        const float x = static_cast<float>(i) * (1.0f + gap);
        builder.quad({x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0});
    }
    return builder.take();
}

TEST(Lamps, SquaresApartAreLampsOfTheirOwn) {
    const Mesh mesh = row(3, 0.5f);
    EXPECT_EQ(lampsOf(mesh, allOf(mesh)), (std::vector<uint32_t>{0, 0, 1, 1, 2, 2}));
}

TEST(Lamps, SquaresThatShareAnEdgeAreOneLampAlthoughTheirVerticesAreTheirOwn) {
    const Mesh mesh = row(4, 0.0f);
    EXPECT_EQ(lampsOf(mesh, allOf(mesh)), std::vector<uint32_t>(8, 0));
}

TEST(Lamps, TrianglesThatAreNotAskedForConnectNothing) {
    const Mesh mesh = row(3, 0.0f);
    EXPECT_EQ(lampsOf(mesh, std::vector<uint32_t>{0, 1, 4, 5}), (std::vector<uint32_t>{0, 0, 1, 1}));
}

TEST(Lamps, PiecesThatMeetLateAreJoined) {
    const Mesh mesh = row(3, 0.0f);
    EXPECT_EQ(lampsOf(mesh, std::vector<uint32_t>{0, 1, 4, 5, 2, 3}), std::vector<uint32_t>(6, 0));
}

TEST(Lamps, MaterialsSeparateThem) {
    Mesh mesh = row(3, 0.0f);
    mesh.materialSlots = {0, 0, 1, 1, 0, 0};
    EXPECT_EQ(lampsOf(mesh, allOf(mesh)), (std::vector<uint32_t>{0, 0, 1, 1, 2, 2}));
}

/// Square lamps of these powers in a row.
Scene lampsOfPowers(const std::vector<float>& powers) {
    Scene scene;
    for (size_t i = 0; i < powers.size(); ++i) {
        Material material;
        material.emission = vec3(powers[i]);
        scene.materials.push_back(material);
        MeshBuilder builder("lamp");
        const float x = 2.0f * static_cast<float>(i);
        builder.quad({x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0});
        scene.meshes.push_back(builder.take());
        Instance instance;
        instance.mesh = instance.material = static_cast<int>(i);
        scene.instances.push_back(instance);
    }
    return scene;
}

bool hasTree(const Scene& scene) {
    return buildSceneData(scene).features.lightTree;
}

TEST(Lamps, ATreeIsBuiltIfPowerWouldStarveOneOfThem) {
    EXPECT_FALSE(hasTree(lampsOfPowers({})));
    EXPECT_FALSE(hasTree(lampsOfPowers({1.0f})));
    EXPECT_FALSE(hasTree(lampsOfPowers(std::vector<float>(9, 1.0f))));
    EXPECT_TRUE(hasTree(lampsOfPowers(std::vector<float>(11, 1.0f))));
    // A quarter of the samples is spread evenly: the weak lamp gets 1/8, or 1/12 of three.
    EXPECT_FALSE(hasTree(lampsOfPowers({1.0f, 1000.0f})));
    EXPECT_TRUE(hasTree(lampsOfPowers({1.0f, 1000.0f, 1000.0f})));
    EXPECT_FALSE(hasTree(lampsOfPowers({0.0f, 1000.0f, 1000.0f}))) << "a lamp that is off is not starved";
}

TEST(Lamps, TheEnvironmentTakesHalfOfTheSamples) {
    Scene scene = lampsOfPowers(std::vector<float>(6, 1.0f));
    EXPECT_FALSE(hasTree(scene));
    scene.environment = softSky();
    EXPECT_TRUE(hasTree(scene));
}

TEST(Lamps, ManyPointLightsNeedATree) {
    Scene scene;
    scene.lights.resize(256);
    EXPECT_FALSE(hasTree(scene));
    scene.lights.emplace_back();
    EXPECT_TRUE(hasTree(scene));
    scene.lights.back().kind = PunctualLight::Kind::Directional;
    EXPECT_FALSE(hasTree(scene)) << "directional lights are in no tree";
}

/// In the static tree triangles are in the world already: shadow rays must not end far before such a lamp.
TEST(Lamps, OnlyThoseWithATreeTellHowLargeTheirOwnCoordinatesAre) {
    Scene scene = lampsOfPowers({1.0f, 1.0f});
    scene.meshes[1] = row(1500, 0.5f);
    scene.instances.push_back(scene.instances[1]);
    for (Mesh& mesh : scene.meshes)
        for (vec3& position : mesh.positions) position.z += 1e6f;
    for (Instance& instance : scene.instances) instance.transform[3].z = -1e6f;
    const SceneData data = buildSceneData(scene);
    ASSERT_TRUE(data.features.twoLevel);
    EXPECT_EQ(data.lights[0].w & layout::LIGHT_MAGNITUDE_MASK, 0u) << "it is copied into the static tree";
    const uint32_t magnitude =
        data.lights[2 * layout::LIGHT_TEXELS].w & layout::LIGHT_MAGNITUDE_MASK;  // after two triangles
    EXPECT_GE(std::bit_cast<float>(magnitude), 2e6f);
}

TEST(Lamps, NoTrianglesAreNoLamps) {
    EXPECT_TRUE(lampsOf(row(1, 0.0f), {}).empty());
}

}  // namespace
}  // namespace limpid::scene
