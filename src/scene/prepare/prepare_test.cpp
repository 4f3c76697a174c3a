// Tests what prepare() adds to a scene (camera, tangents, sky) and what it rejects.
#include "scene/prepare/prepare.h"

#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "scene/builtin/mesh_builder.h"
#include "scene/framing/framing.h"
#include "scene/lights/environment.h"
#include "scene/load/loader_test_files.h"
#include "scene/load/validate.h"
#include "scene/prepare/tangents.h"

namespace limpid::scene::test {
namespace {

/// A square of two triangles in the XY plane with an upright texture.
Scene squareScene() {
    Scene scene;
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.normals.assign(4, vec3(0, 0, 1));
    mesh.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    scene.meshes.push_back(mesh);
    scene.instances.push_back({});
    scene.materials.emplace_back();
    return scene;
}

void addQuad(Mesh& mesh, const vec3& a, const vec3& b, const vec3& c, const vec3& d) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {a, b, c, d});
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
}

/// The cube from 0 to 1 seen from inside, without its last `missing` sides (+Z, then -Z).
Scene roomScene(int missing) {
    Scene scene = squareScene();
    Mesh& mesh = scene.meshes[0] = {};
    addQuad(mesh, {0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1});
    addQuad(mesh, {1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0});
    addQuad(mesh, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0});
    addQuad(mesh, {0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1});
    if (missing < 2) addQuad(mesh, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    if (missing < 1) addQuad(mesh, {0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1});
    return scene;
}

void expectInView(const Camera& camera, const vec3& point) {
    const vec3 p = vec3(glm::inverse(camera.toWorld) * vec4(point, 1.0f));
    const float slope = std::tan(camera.verticalFov / 2);
    EXPECT_LT(p.z, 0.0f);
    EXPECT_LE(std::abs(p.x), -p.z * slope);
    EXPECT_LE(std::abs(p.y), -p.z * slope);
}

// --- camera
// -----------------------------------------------------------------------------------------------------

TEST(Prepare, FramesEverythingFromTheFront) {
    Scene scene = squareScene();
    scene.instances.push_back({0, 0, mat4(1.0f), "moved"});
    scene.instances[1].transform[3] = vec4(10, 20, -30, 1);
    prepare(scene);
    ASSERT_EQ(scene.cameras.size(), 1u);
    for (const Instance& instance : scene.instances) {
        for (const vec3& p : scene.meshes[0].positions) {
            expectInView(scene.cameras[0], vec3(instance.transform * vec4(p, 1.0f)));
        }
    }
    EXPECT_GT(scene.cameras[0].toWorld[2].z, 0.5f) << "seen from +Z";
    EXPECT_GT(scene.cameras[0].toWorld[2].y, 0.1f) << "a little from above";
    EXPECT_EQ(findFault(scene), std::nullopt);
}

TEST(Prepare, LooksStraightThroughTheOpenSideOfARoom) {
    const Camera camera = frameScene(roomScene(1));
    EXPECT_EQ(vec3(camera.toWorld[2]), vec3(0, 0, 1));
    EXPECT_GT(camera.toWorld[3].z, 1.0f);
    EXPECT_NEAR(camera.toWorld[3].x, 0.5f, 1e-5f);
    expectInView(camera, vec3(0, 0, 1));
}

TEST(Prepare, StandsInsideAClosedRoomButOutsideABox) {
    Scene scene = roomScene(0);
    EXPECT_LT(frameScene(scene).toWorld[3].z, 1.0f);
    for (size_t i = 0; i < scene.meshes[0].indices.size(); i += 3) {
        std::swap(scene.meshes[0].indices[i], scene.meshes[0].indices[i + 1]);
    }
    EXPECT_GT(frameScene(scene).toWorld[3].z, 1.0f);
}

/// As in OBJ files and Blender's cubes: walls that face outward and are double-sided, with an object inside.
TEST(Prepare, StandsInsideARoomWhoseWallsFaceOutward) {
    const auto outwardRoom = [](bool bothSides, bool table, bool lamp) {
        Scene scene = roomScene(0);
        for (vec3& p : scene.meshes[0].positions) p *= vec3(4, 2.5f, 5);
        std::vector<uint32_t>& indices = scene.meshes[0].indices;
        for (size_t i = 0; i < indices.size(); i += 3) std::swap(indices[i], indices[i + 1]);
        scene.materials[0].doubleSided = bothSides;
        if (table) addQuad(scene.meshes[0], {1, 1, 2}, {1, 1, 3}, {2, 1, 3}, {2, 1, 2});
        if (lamp) scene.lights.push_back({.position = {2, 2, 2}});
        return scene;
    };
    const auto isInside = [](const Scene& scene) {
        const vec3 eye(frameScene(scene).toWorld[3]);
        return glm::all(glm::greaterThan(eye, vec3(0.0f))) && glm::all(glm::lessThan(eye, vec3(4, 2.5f, 5)));
    };
    EXPECT_TRUE(isInside(outwardRoom(true, true, false)));
    EXPECT_TRUE(isInside(outwardRoom(true, false, true)));
    EXPECT_TRUE(isInside(outwardRoom(false, true, true)));
    EXPECT_FALSE(isInside(outwardRoom(true, false, false))) << "a box";
    EXPECT_FALSE(isInside(outwardRoom(false, true, false))) << "its walls cannot be seen from within";
}

/// The larger of a mesh's width and height in a square picture, and whether it is completely visible.
struct Seen {
    float size = 0.0f;
    bool whole = true;
};

Seen seenBy(const Camera& camera, const std::vector<vec3>& positions, const mat4& transform = mat4(1.0f)) {
    vec2 lower(1e30f), upper(-1e30f);
    for (const vec3& position : positions) {
        const vec3 p(glm::inverse(camera.toWorld) * transform * vec4(position, 1.0f));
        const vec2 at = vec2(p) / (-p.z * std::tan(camera.verticalFov / 2));
        lower = glm::min(lower, at);
        upper = glm::max(upper, at);
        if (p.z >= 0.0f) return {0.0f, false};
    }
    const vec2 size = 0.5f * (upper - lower);
    return {std::max(size.x, size.y),
            glm::all(glm::greaterThan(lower, vec2(-1))) && glm::all(glm::lessThan(upper, vec2(1)))};
}

TEST(Prepare, ModelsFillThePicture) {
    Scene scene = squareScene();
    std::vector<vec3>& positions = scene.meshes[0].positions;
    scene.meshes[0].normals.clear();
    const std::vector<std::vector<vec3>> models{
        {{0, 0, 0}, {1, 0.02f, 1}, {1, 1, 1}, {0, 0.98f, 0}},                  // a screen at an angle
        {{-3, 0, 3}, {-2.9f, 0, 3}, {3, 6, -3}, {2.9f, 6, -3}},                // a diagonal beam
        {{-90, 0, 4400}, {90, 0, 4400}, {90, 200, -4400}, {-90, 200, -4400}},  // a street in centimetres
        {{0, 0, 0}, {1e-3f, 0, 0}, {1e-3f, 1e-3f, 1e-3f}, {0, 1e-3f, 1e-3f}},
        {{1000, 0, 1000}, {1000.5f, 0, 1000}, {1000.5f, 1, 1000.2f}, {1000, 1, 1000}}};
    for (size_t i = 0; i < models.size(); ++i) {
        positions = models[i];
        const Seen seen = seenBy(frameScene(scene), positions);
        EXPECT_TRUE(seen.whole) << i;
        EXPECT_GT(seen.size, 0.9f) << i;
    }
}

TEST(Prepare, ABlockWithSomethingOnItsBackIsNoRoom) {
    Scene scene = squareScene();
    scene.meshes[0] = MeshBuilder("block")
                          .box({-1, -1, -1}, {1, 1, 1})
                          .box({-0.1f, -0.1f, -1.2f}, {0.1f, 0.1f, -1.1f})
                          .take();
    EXPECT_GT(frameScene(scene).toWorld[3].z, 1.0f);
}

/// A clip that moves a small object far away.
TEST(Prepare, WhatAClipTakesAwayFillsHalfOfThePicture) {
    for (const float distance : {0.5f, 200.0f}) {
        Scene scene = squareScene();
        scene.rig.nodes.emplace_back();
        scene.instances[0].node = 0;
        scene.instances[0].movement = Movement::Rigid;
        scene.clip = 0;
        scene.rig.order = {0};
        scene.rig.clips = {
            {"away",
             {{0, AnimatedValue::Translation, Interpolation::Linear, 3, {0, 1}, {0, 0, 0, distance, 0, 0}}}}};
        const Camera camera = frameScene(scene);
        const Seen first = seenBy(camera, scene.meshes[0].positions);
        EXPECT_TRUE(first.whole) << distance;
        EXPECT_GE(first.size, 0.5f) << distance;
        const mat4 moved = glm::translate(mat4(1.0f), vec3(distance, 0, 0));
        EXPECT_EQ(seenBy(camera, scene.meshes[0].positions, moved).whole, distance < 1.0f);
    }
}

/// Two rooms behind each other, of which the front one is a small closet.
TEST(Prepare, StandsInTheLargestRoomOfABuilding) {
    Scene scene = roomScene(0);
    Mesh& mesh = scene.meshes[0];
    for (vec3& p : mesh.positions) p *= vec3(4, 1, 5);
    for (const float side : {0.0f, 0.02f}) {  // a thick wall
        addQuad(mesh, {0, 0, 4 + side}, {4, 0, 4 + side}, {4, 1, 4 + side}, {0, 1, 4 + side});
        addQuad(mesh, {0, 0, 4 + side}, {0, 1, 4 + side}, {4, 1, 4 + side}, {4, 0, 4 + side});
    }
    const mat4 camera = frameScene(scene).toWorld;
    EXPECT_LT(camera[3].z, 4.0f) << "not in the closet";
    const vec3 ahead = vec3(camera[3]) - 2.0f * vec3(camera[2]);
    EXPECT_TRUE(ahead.x > 0 && ahead.x < 4 && ahead.z > 0 && ahead.z < 4) << "with two metres before it";
    EXPECT_NEAR(camera[3].y, 0.5f, 1e-5f);
}

TEST(Prepare, FramesDegenerateScenes) {
    Scene empty;
    empty.materials.emplace_back();
    prepare(empty);
    EXPECT_EQ(empty.cameras.size(), 1u);
    Scene point = squareScene();
    for (vec3& p : point.meshes[0].positions) p = vec3(3.0f);
    prepare(point);
    EXPECT_EQ(findFault(point), std::nullopt);
}

TEST(Prepare, KeepsTheCameraThatThereIs) {
    Scene scene = squareScene();
    scene.cameras.emplace_back().name = "mine";
    prepare(scene);
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].name, "mine");
}

// --- light
// ------------------------------------------------------------------------------------------------------

TEST(Prepare, AddsASkyOnlyWhereNothingShines) {
    Scene dark = squareScene();
    dark.materials.emplace_back().emission = vec3(1.0f);  // not used by any triangle
    prepare(dark);
    EXPECT_FALSE(dark.environment.empty());

    Scene emissive = squareScene();
    emissive.materials.emplace_back().emission = vec3(1.0f);
    emissive.meshes[0].materialSlots = {0, 1};
    prepare(emissive);
    EXPECT_TRUE(emissive.environment.empty());

    Scene punctual = squareScene();
    punctual.lights.emplace_back();
    prepare(punctual);
    EXPECT_TRUE(punctual.environment.empty());
}

/// A cube with a small lamp on its back.
Scene cubeWithALamp() {
    Scene scene = squareScene();
    scene.meshes[0] = MeshBuilder("cube")
                          .box({-1, -1, -1}, {1, 1, 1})
                          .box({-0.1f, -0.1f, -1.2f}, {0.1f, 0.1f, -1.1f}, 1)
                          .take();
    scene.materials.resize(2);
    scene.materials[1].emission = vec3(10.0f);
    return scene;
}

TEST(Prepare, AddsASkyWhereTheScenesLightsLeaveItDark) {
    const auto getsSky = [](Scene scene, SkyRule rule = SkyRule::InTheDark) {
        prepare(scene, rule);
        return !scene.environment.empty();
    };
    EXPECT_TRUE(getsSky(cubeWithALamp()));
    EXPECT_FALSE(getsSky(cubeWithALamp(), SkyRule::WithoutLights));
    EXPECT_FALSE(getsSky(cubeWithALamp(), SkyRule::Never));
    EXPECT_FALSE(getsSky(squareScene(), SkyRule::Never));
    Scene lit = cubeWithALamp();
    lit.meshes[0] =
        MeshBuilder("cube").box({-1, -1, -1}, {1, 1, 1}).box({0.5f, 1.5f, 2}, {0.8f, 1.8f, 2.2f}, 1).take();
    EXPECT_FALSE(getsSky(lit));

    Scene punctual = squareScene();
    punctual.lights = {{.kind = PunctualLight::Kind::Spot, .position = {0.5f, 0.5f, 2}}};
    EXPECT_FALSE(getsSky(punctual));
    punctual.lights[0].direction = {0, 1, 0};
    EXPECT_TRUE(getsSky(punctual)) << "shines elsewhere";
    punctual.lights[0].direction = {0, 0, -1};
    punctual.lights[0].range = 1.0f;
    EXPECT_TRUE(getsSky(punctual)) << "does not reach";
    punctual.lights[0].range = 0.0f;
    punctual.lights[0].intensity = vec3(0.0f);
    EXPECT_TRUE(getsSky(punctual)) << "is off";
}

/// A lamp close to a square of area 1 lights a disc.
TEST(Prepare, AddsASkyIfThreeQuartersOfWhatIsSeenAreDark) {
    constexpr float pi = 3.14159265f, height = 0.01f;
    for (const float lit : {0.22f, 0.28f}) {
        Scene scene = squareScene();
        scene.lights = {{.kind = PunctualLight::Kind::Point, .position = {0.5f, 0.5f, height}}};
        scene.lights[0].range = std::sqrt(lit / pi + height * height);
        prepare(scene, SkyRule::InTheDark);
        EXPECT_EQ(!scene.environment.empty(), lit < 0.25f) << lit;
    }
}

/// A texture that is black except for JPEG artefacts, and one that is not.
TEST(Prepare, KnowsBlackEmissionTextures) {
    for (const uint8_t level : {uint8_t{3}, uint8_t{90}}) {
        Scene scene = squareScene();
        scene.textures.push_back({"emission", 1, 1, {level, level, level, 255}, true, {}});
        scene.materials[0].emission = vec3(1.0f);
        scene.materials[0].emissionTexture.texture = 0;
        prepare(scene, SkyRule::InTheDark);
        EXPECT_EQ(scene.environment.empty(), level == 90);
    }
}

TEST(Prepare, AddsASkyToTheDarkOnesOfTheSharedScenes) {
    const auto scenes = sharedScenes();
    if (!scenes) GTEST_SKIP() << "the shared scenes are missing";
    const std::vector<std::pair<const char*, bool>> expected{
        {"cornell_box_glb/CornellBox.glb", false},
        {"cornell_box_obj/cornell_box.obj", false},
        {"lights_punctual_lamp/LightsPunctualLamp.gltf", false},
        {"stained_glass_lamp/StainedGlassLamp.gltf", false},
        {"emissive_strength_test/EmissiveStrengthTest.gltf", false},
        {"low_poly_jungle/scene.gltf", true}};
    for (const auto& [path, sky] : expected) {
        Scene scene = loadScene(*scenes / path);
        prepare(scene, SkyRule::InTheDark);
        EXPECT_EQ(!scene.environment.empty(), sky) << path;
    }
}

TEST(Environment, MapsDirectionsAsDocumented) {
    const auto near = [](const vec2& a, const vec2& b) { return glm::distance(a, b) < 1e-6f; };
    EXPECT_TRUE(near(directionToUv({0, 0, -1}), {0.5f, 0.5f}));
    EXPECT_TRUE(near(directionToUv({1, 0, 0}), {0.75f, 0.5f}));
    EXPECT_TRUE(near(directionToUv({-1, 0, 0}), {0.25f, 0.5f}));
    EXPECT_EQ(directionToUv({0, 1, 0}).y, 0.0f);
    const vec3 d = glm::normalize(vec3(0.3f, -0.5f, 0.8f));
    EXPECT_LT(glm::distance(uvToDirection(directionToUv(d)), d), 1e-6f);
}

TEST(Environment, LoadsTheSharedOnes) {
    const auto scenes = sharedScenes();
    if (!scenes) GTEST_SKIP() << "the shared scenes are missing";
    const Environment noon = loadEnvironment(*scenes / "env" / "noon_grass_1k.hdr");
    EXPECT_EQ(noon.width, 1024u);
    EXPECT_EQ(noon.radiance.size(), 1024u * 512u);
    float brightest = 0.0f;
    for (const vec3& radiance : noon.radiance) brightest = std::max(brightest, radiance.y);
    EXPECT_GT(brightest, 100.0f) << "the sun";
}

// --- tangents
// ---------------------------------------------------------------------------------------------------

TEST(Tangents, PointAlongUWithTheHandednessOfThePicture) {
    Mesh mesh = squareScene().meshes[0];
    generateTangents(mesh, 0);
    ASSERT_EQ(mesh.tangents.size(), 4u);
    for (const vec4& tangent : mesh.tangents) EXPECT_LT(glm::distance(tangent, vec4(1, 0, 0, 1)), 1e-6f);
    for (vec2& uv : mesh.uv0) uv.x = 1.0f - uv.x;
    generateTangents(mesh, 0);
    for (const vec4& tangent : mesh.tangents) EXPECT_LT(glm::distance(tangent, vec4(-1, 0, 0, -1)), 1e-6f);
}

TEST(Tangents, SplitVerticesBetweenAPictureAndItsMirrorImage) {
    Mesh mesh;
    mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
    mesh.normals.assign(4, vec3(0, 0, 1));
    mesh.uv0 = {{1, 1}, {0, 1}, {0, 0}, {1, 1}};
    mesh.indices = {0, 1, 2, 1, 3, 2};
    generateTangents(mesh, 0);
    EXPECT_EQ(mesh.positions.size(), 6u);
    EXPECT_EQ(mesh.tangents[mesh.indices[1]], vec4(-1, 0, 0, -1));
    EXPECT_EQ(mesh.tangents[mesh.indices[3]], vec4(1, 0, 0, 1));
}

TEST(Tangents, AreAddedOnlyForNormalMapsAndWithFlatNormalsIfNeeded) {
    Scene scene = squareScene();
    scene.meshes[0].normals.clear();
    prepare(scene);
    EXPECT_TRUE(scene.meshes[0].tangents.empty());
    scene.textures.push_back({"n", 1, 1, {128, 128, 255, 255}, false, {}});
    scene.materials[0].normalTexture.texture = 0;
    prepare(scene);
    EXPECT_EQ(scene.meshes[0].tangents.size(), 6u);
    EXPECT_EQ(scene.meshes[0].normals.size(), 6u);
    EXPECT_EQ(findFault(scene), std::nullopt);
}

TEST(Tangents, AgreeWithThoseThatFilesBring) {
    const auto scenes = sharedScenes();
    if (!scenes) GTEST_SKIP() << "the shared scenes are missing";
    for (const char* path :
         {"flight_helmet/FlightHelmet.gltf", "normal_tangent_mirror_test/NormalTangentMirrorTest.glb"}) {
        size_t corners = 0, agree = 0;
        for (const Mesh& mesh : loadScene(*scenes / path).meshes) {
            Mesh own = mesh;
            generateTangents(own, 0);
            for (size_t i = 0; i < mesh.indices.size() && !mesh.tangents.empty(); ++i) {
                const vec4& given = mesh.tangents[mesh.indices[i]];
                const vec4& ours = own.tangents[own.indices[i]];
                ++corners;
                agree += given.w == ours.w && glm::dot(vec3(given), vec3(ours)) > 0.9f;
            }
        }
        EXPECT_GT(corners, 0u);
        EXPECT_GT(static_cast<double>(agree) / static_cast<double>(corners), 0.97) << path;
    }
}

// --- invariants
// -------------------------------------------------------------------------------------------------

TEST(Prepare, RefusesBrokenScenes) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<std::function<void(Scene&)>> faults = {
        [](Scene& s) { s.materials.clear(); },
        [](Scene& s) { s.meshes[0].indices[3] = 4; },
        [](Scene& s) { s.meshes[0].indices.pop_back(); },
        [](Scene& s) { s.meshes[0].normals.pop_back(); },
        [](Scene& s) { s.meshes[0].normals[0] = vec3(0.0f); },
        [](Scene& s) { s.meshes[0].tangents.assign(4, vec4(1, 0, 0, 0)); },
        [](Scene& s) { s.meshes[0].materialSlots = {0}; },
        [](Scene& s) {
            s.meshes[0].materialSlots = {0, 1};
        },
        [&](Scene& s) { s.meshes[0].positions[1].y = nan; },
        [&](Scene& s) { s.meshes[0].uv0[1].y = nan; },
        [](Scene& s) { s.instances[0].mesh = 1; },
        [](Scene& s) { s.instances[0].mesh = -1; },
        [](Scene& s) { s.instances[0].material = -1; },
        [](Scene& s) { s.instances[0].material = 1; },
        [&](Scene& s) { s.instances[0].transform[3].x = nan; },
        [](Scene& s) { s.instances[0].transform[0].x = 1e30f; },
        [](Scene& s) { s.instances[0].transform[3].x = 2e12f; },
        [](Scene& s) {
            s.instances[0].transform = mat4(mat3(1e-6f));
            for (vec3& p : s.meshes[0].positions) p = 1e13f * (p + 1.0f);
        },
        [](Scene& s) { s.materials[0].emission.x = -1.0f; },
        [&](Scene& s) { s.materials[0].roughness = nan; },
        [](Scene& s) { s.materials[0].baseColorTexture.texture = 0; },
        [](Scene& s) {
            s.textures.push_back({"t", 2, 2, {1, 2, 3}, false, {}});
        },
        [](Scene& s) { s.lights.emplace_back().direction = vec3(0.0f); },
        [](Scene& s) { s.cameras.emplace_back().toWorld *= 2.0f; },
        [](Scene& s) { s.environment.width = 3; },
        [&](Scene& s) {
            s.environment = {1, 1, {vec3(nan)}};
        },
    };
    for (size_t i = 0; i < faults.size(); ++i) {
        Scene scene = squareScene();
        faults[i](scene);
        EXPECT_THROW(prepare(scene), Error) << "fault " << i;
    }
    Scene far = squareScene();
    far.instances[0].transform[3].x = 5e11f;
    EXPECT_EQ(findFault(far), std::nullopt);
}

// --- alpha

/// The square with a texture of 2x1 texels, the second of which has this alpha.
Scene maybeTransparent(AlphaMode mode, uint8_t alpha) {
    Scene scene = squareScene();
    scene.textures.push_back({.name = "t", .width = 2, .height = 1, .rgba = {9, 9, 9, 255, 9, 9, 9, alpha}});
    scene.materials[0].alphaMode = mode;
    scene.materials[0].baseColorTexture.texture = 0;
    return scene;
}

AlphaMode prepared(Scene scene) {
    prepare(scene);
    return scene.materials[0].alphaMode;
}

TEST(Prepare, WhatLetsNothingThroughIsOpaque) {
    EXPECT_EQ(prepared(maybeTransparent(AlphaMode::Blend, 255)), AlphaMode::Opaque);
    EXPECT_EQ(prepared(maybeTransparent(AlphaMode::Blend, 254)), AlphaMode::Blend);
    EXPECT_EQ(prepared(maybeTransparent(AlphaMode::Mask, 128)), AlphaMode::Opaque);
    EXPECT_EQ(prepared(maybeTransparent(AlphaMode::Mask, 127)), AlphaMode::Mask);
    Scene scene = maybeTransparent(AlphaMode::Blend, 255);
    scene.materials[0].baseColor.a = 0.99f;
    EXPECT_EQ(prepared(scene), AlphaMode::Blend);
    scene.materials[0].alphaMode = AlphaMode::Mask;
    scene.materials[0].alphaCutoff = 1.5f;
    EXPECT_EQ(prepared(scene), AlphaMode::Mask) << "this one is nowhere";
}

TEST(Prepare, ColoursOfVerticesCountWhereTheMaterialIsUsed) {
    Scene scene = squareScene();
    scene.materials.emplace_back();
    for (Material& material : scene.materials) material.alphaMode = AlphaMode::Blend;
    Mesh& mesh = scene.meshes[0];
    mesh.materialSlots = {0, 1};
    mesh.colors.assign(4, vec4(1.0f));
    mesh.colors[3].a = 0.5f;  // of the second triangle only
    prepare(scene);
    EXPECT_EQ(scene.materials[0].alphaMode, AlphaMode::Opaque);
    EXPECT_EQ(scene.materials[1].alphaMode, AlphaMode::Blend);
}

}  // namespace
}  // namespace limpid::scene::test
