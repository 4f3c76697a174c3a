#include "scene/builtin/builtin.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "scene/builtin/builtin_lab.h"
#include "scene/builtin/builtin_parts.h"
#include "scene/builtin/mesh_builder.h"
#include "scene/builtin/random_room.h"
#include "scene/builtin/random_still_life.h"
#include "scene/model/camera.h"

namespace limpid::scene {
namespace {

enum CornellSlot : uint16_t { White, Red, Green, Light };

/// Converts the data's millimetres (camera at negative z, x to the left) to our metres, x centred.
vec3 fromData(float x, float y, float z) {
    return vec3(278.0f - x, y, 279.6f - z) * 1e-3f;
}

void addCornellRoom(MeshBuilder& builder) {
    const auto p = fromData;
    builder.quad(p(552.8f, 0, 0), p(0, 0, 0), p(0, 0, 559.2f), p(549.6f, 0, 559.2f), White);
    builder.quad(p(556, 548.8f, 0), p(556, 548.8f, 559.2f), p(0, 548.8f, 559.2f), p(0, 548.8f, 0), White);
    builder.quad(p(549.6f, 0, 559.2f), p(0, 0, 559.2f), p(0, 548.8f, 559.2f), p(556, 548.8f, 559.2f), White);
    builder.quad(p(0, 0, 559.2f), p(0, 0, 0), p(0, 548.8f, 0), p(0, 548.8f, 559.2f), Green);
    builder.quad(p(552.8f, 0, 0), p(549.6f, 0, 559.2f), p(556, 548.8f, 559.2f), p(556, 548.8f, 0), Red);
    // In the data, the light fills a hole in the ceiling; half a millimetre below, it needs no hole.
    builder.quad(p(343, 548.3f, 227), p(343, 548.3f, 332), p(213, 548.3f, 332), p(213, 548.3f, 227), Light);
}

Scene emptyCornell(std::string name) {
    Scene scene;
    scene.name = std::move(name);
    scene.materials = {lambertian("white", vec3(0.73f)), lambertian("red", {0.65f, 0.05f, 0.05f}),
                       lambertian("green", {0.12f, 0.45f, 0.15f}),
                       emitter("light", vec3(0.78f), {18.4f, 15.6f, 8.0f})};
    // A lens of 35 mm with a film of 25 mm, 800 mm in front of the box.
    scene.cameras = {lookAt(fromData(278, 273, -800), fromData(278, 273, 0), vec3(0, 1, 0),
                            2.0f * std::atan(12.5f / 35.0f))};
    scene.cameras[0].name = "cornell";
    return scene;
}

}  // namespace

Scene cornellScene() {
    Scene scene = emptyCornell("cornell");
    MeshBuilder builder("cornell");
    addCornellRoom(builder);
    const auto p = fromData;
    builder.prism(p(130, 0, 65), p(82, 0, 225), p(240, 0, 272), p(290, 0, 114), 0.165f, White);
    builder.prism(p(423, 0, 247), p(265, 0, 296), p(314, 0, 456), p(472, 0, 406), 0.330f, White);
    addMesh(scene, builder.take(), 0);
    return scene;
}

Scene cornellSpheresScene() {
    Scene scene = emptyCornell("cornell-spheres");
    MeshBuilder room("room");
    addCornellRoom(room);
    addMesh(scene, room.take(), 0);
    Material glass = glossy("glass", vec3(1.0f), 0.0f, 0.0f);
    glass.transmission = 1.0f;
    glass.thin = false;
    const auto addSphere = [&](const Material& material, const vec3& center, float radius) {
        scene.materials.push_back(material);
        MeshBuilder builder(material.name, true);
        builder.sphere(center, radius, 96, 48);
        addMesh(scene, builder.take(), static_cast<int>(scene.materials.size() - 1));
    };
    addSphere(glass, {0.13f, 0.1f, 0.1f}, 0.1f);
    addSphere(glossy("mirror", vec3(0.95f), 1.0f, 0.0f), {-0.13f, 0.12f, -0.1f}, 0.12f);
    addSphere(glossy("glossy", {0.9f, 0.6f, 0.25f}, 1.0f, 0.35f), {0.0f, 0.06f, 0.17f}, 0.06f);
    return scene;
}

Scene cornellMovingScene() {
    Scene scene = emptyCornell("cornell-moving");
    MeshBuilder room("room");
    addCornellRoom(room);
    const auto p = fromData;
    room.prism(p(423, 0, 247), p(265, 0, 296), p(314, 0, 456), p(472, 0, 406), 0.330f, White);
    addMesh(scene, room.take(), 0);
    MeshBuilder block("block");
    block.box({-0.08f, 0.0f, -0.08f}, {0.08f, 0.165f, 0.08f}, White);
    const int blockNode = addNode(scene, addMesh(scene, block.take(), 0));
    MeshBuilder lamp("lamp");
    lamp.box(vec3(-0.025f), vec3(0.025f), Light);
    const int lampNode = addNode(scene, addMesh(scene, lamp.take(), 0));

    const auto spline = [](int node, std::vector<float> positions) {
        Channel channel{node, AnimatedValue::Translation, Interpolation::CubicSpline, 3, {0, 1, 2, 3, 4}, {}};
        for (size_t i = 0; i < positions.size(); i += 3) {
            channel.values.insert(channel.values.end(), 3, 0.0f);
            channel.values.insert(channel.values.end(), &positions[i], &positions[i] + 3);
            channel.values.insert(channel.values.end(), 3, 0.0f);
        }
        return channel;
    };
    Channel turn{blockNode, AnimatedValue::Rotation, Interpolation::Linear, 4, {0, 1, 2, 3, 4}, {}};
    for (int i = 0; i <= 4; ++i) {
        const float half = 0.5f * (0.3f + 0.5f * pi * static_cast<float>(i));
        turn.values.insert(turn.values.end(), {0.0f, std::sin(half), 0.0f, std::cos(half)});
    }
    const Channel slide = spline(blockNode, {0.11f, 0.0f, 0.1f, -0.05f, 0.0f, 0.16f, -0.15f, 0.0f, 0.12f,  //
                                             0.02f, 0.05f, 0.18f, 0.11f, 0.0f, 0.1f});
    const Channel swing = spline(lampNode, {-0.18f, 0.42f, 0.1f, 0.0f, 0.36f, 0.14f, 0.18f, 0.42f, 0.1f,  //
                                            0.0f, 0.36f, -0.02f, -0.18f, 0.42f, 0.1f});
    addClip(scene, {"moving", {slide, turn, swing}});
    return scene;
}

Scene heavyScene() {
    Scene scene;
    scene.name = "heavy";
    scene.materials = {lambertian("wall", vec3(0.7f)), lambertian("floor", {0.5f, 0.45f, 0.4f}),
                       lambertian("rust", {0.7f, 0.3f, 0.2f}), lambertian("teal", {0.2f, 0.5f, 0.55f}),
                       emitter("light", vec3(0.5f), vec3(12.0f))};
    MeshBuilder builder("heavy");
    builder.box({-5, 0, -5}, {5, 4, 5}, 0, true);
    builder.quad({-5, 0.001f, 5}, {5, 0.001f, 5}, {5, 0.001f, -5}, {-5, 0.001f, -5}, 1);
    for (const float x : {-2.5f, 2.5f}) {
        for (const float z : {-2.5f, 2.5f}) {
            builder.quad({x - 0.6f, 3.99f, z - 0.6f}, {x + 0.6f, 3.99f, z - 0.6f},
                         {x + 0.6f, 3.99f, z + 0.6f}, {x - 0.6f, 3.99f, z + 0.6f}, 4);
        }
    }
    Sequence random;
    for (int row = 0; row < 6; ++row) {
        for (int column = 0; column < 6; ++column) {
            const vec3 center(-4.0f + 1.6f * static_cast<float>(column) + random.next(-0.2f, 0.2f),
                              random.next(0.55f, 2.2f),
                              -4.0f + 1.5f * static_cast<float>(row) + random.next(-0.2f, 0.2f));
            const auto slot = static_cast<uint16_t>((row + column) % 2 == 0 ? 2 : 3);
            builder.torus(center, 0.45f, 0.12f, 64, 32, slot);
            builder.sphere(center, random.next(0.15f, 0.3f), 64, 32, slot);
        }
    }
    addMesh(scene, builder.take(), 0);
    scene.cameras = {lookAt({0, 1.7f, 4.8f}, {0, 1.2f, 0}, {0, 1, 0}, 1.1f)};
    scene.cameras[0].name = "heavy";
    return scene;
}

Scene furnaceScene(float albedo) {
    Scene scene;
    scene.name = "furnace";
    scene.materials = {emitter("furnace", vec3(albedo), vec3(1.0f))};
    scene.materials[0].doubleSided = true;
    MeshBuilder builder("furnace");
    builder.box(vec3(-2.0f), vec3(2.0f), 0, true);
    builder.box({-0.7f, -2.0f, -0.9f}, {0.5f, -0.5f, 0.2f}, 0);
    builder.sphere({0.8f, -0.2f, 0.1f}, 0.6f, 32, 16, 0);
    addMesh(scene, builder.take(), 0);
    scene.cameras = {lookAt({0.2f, 0.1f, 1.9f}, {0, -0.3f, 0}, {0, 1, 0}, 1.0f)};
    scene.cameras[0].name = "furnace";
    return scene;
}

namespace {

struct Entry {
    const char* name;
    const char* help;
    Scene (*make)();
};

constexpr Entry entries[] = {
    {"cornell", "the Cornell box, true dimensions, diffuse, 36 triangles", cornellScene},
    {"cornell-spheres", "the Cornell box with a glass, a mirror and a glossy sphere", cornellSpheresScene},
    {"cornell-moving", "the Cornell box with a sliding block and a swinging light, 4 s", cornellMovingScene},
    {"heavy", "about 300,000 triangles in a closed lit room, diffuse", heavyScene},
    {"furnace", "a closed room where every surface emits 1 and reflects half: known brightness",
     [] { return furnaceScene(); }},
    {"lab-light", "a diffuse room whose only light slides along the ceiling until 1 s, then stays; 4 s",
     labLightScene},
    {"lab-switch", "the same room with two lights, of which one goes out at 1 s; 4 s", labSwitchScene},
    {"lab-disocclusion", "a grille that moves fast before a textured wall and floor, 4 s",
     labDisocclusionScene},
    {"lab-mirror", "a picture seen directly and in a mirror, on a glossy floor", labMirrorScene},
    {"lab-textures", "brick, checker, plaster, wood, bumps and uneven gloss, at grazing angles too",
     labTexturesScene},
    {"lab-glass", "a glass ball, a bottle with a liquid and a window, before checkers and bricks",
     labGlassScene},
    {"lab-lights", "a hall with 220 small coloured lights and diffuse and glossy blocks", labLightsScene},
};

/// Parses N from a name that consists of `prefix` and N.
std::optional<uint32_t> seedAfter(std::string_view prefix, std::string_view name) {
    if (!name.starts_with(prefix)) return std::nullopt;
    name.remove_prefix(prefix.size());
    uint32_t seed = 0;
    const auto [end, fault] = std::from_chars(name.data(), name.data() + name.size(), seed);
    if (fault != std::errc() || end != name.data() + name.size()) return std::nullopt;
    return seed;
}

}  // namespace

std::vector<BuiltinInfo> builtinScenes() {
    std::vector<BuiltinInfo> infos;
    for (const Entry& entry : entries) infos.push_back({entry.name, entry.help});
    return infos;
}

Scene builtinScene(std::string_view name) {
    if (const std::optional<uint32_t> seed = seedAfter("room-", name)) return randomRoom(*seed);
    if (const std::optional<uint32_t> seed = seedAfter("still-life-", name)) return randomStillLife(*seed);
    std::string names;
    for (const Entry& entry : entries) {
        if (name == entry.name) return entry.make();
        names += std::string(" builtin:") + entry.name;
    }
    throw UsageError("there is no scene 'builtin:" + std::string(name) + "'; the built-in scenes are" +
                     names + " builtin:room-N builtin:still-life-N");
}

}  // namespace limpid::scene
