#include "scene/builtin/builtin_lab.h"

#include <cmath>

#include "scene/builtin/builtin_parts.h"
#include "scene/builtin/mesh_builder.h"
#include "scene/builtin/procedural_textures.h"

namespace limpid::scene {
namespace {

// --- lab-light, lab-switch

constexpr float studioHeight = 2.8f;
enum StudioSlot : uint16_t { StudioWall, StudioLeft, StudioRight, StudioBlock, StudioLight };

/// The room shared by both scenes: 5 m with five blocks.
Scene studio(std::string name) {
    Scene scene;
    scene.name = std::move(name);
    scene.materials = {lambertian("wall", vec3(0.72f)), lambertian("left", {0.6f, 0.2f, 0.12f}),
                       lambertian("right", {0.14f, 0.3f, 0.5f}), lambertian("block", {0.7f, 0.6f, 0.42f})};
    MeshBuilder room("room");
    room.box({-2.5f, 0.0f, -2.5f}, {2.5f, studioHeight, 2.5f},
             {StudioLeft, StudioRight, StudioWall, StudioWall, StudioWall, StudioWall}, true);
    addBlock(room, {-1.1f, -1.2f}, {0.35f, 0.35f}, 1.5f, 0.4f, StudioBlock);
    addBlock(room, {0.2f, -0.6f}, {0.3f, 0.3f}, 0.6f, -0.3f, StudioWall);
    addBlock(room, {1.3f, -1.1f}, {0.25f, 0.6f}, 1.0f, 0.2f, StudioBlock);
    addBlock(room, {-0.6f, 0.3f}, {0.2f, 0.2f}, 0.4f, 0.9f, StudioWall);
    addBlock(room, {0.9f, 0.2f}, {0.12f, 0.12f}, 0.9f, 0.1f, StudioWall);
    addMesh(scene, room.take(), 0);
    addCamera(scene, {0.0f, 1.55f, 2.4f}, {0.0f, 1.2f, -1.0f}, 1.05f);
    return scene;
}

/// Adds a light around its node's origin.
int addMovingLamp(Scene& scene, const vec3& radiance) {
    scene.materials.push_back(emitter("key", vec3(0.5f), radiance));
    MeshBuilder lamp("key");
    addLamp(lamp, vec3(0.0f), 0.4f, 0.25f, 0);
    return addNode(scene, addMesh(scene, lamp.take(), static_cast<int>(scene.materials.size() - 1)));
}

// --- lab-disocclusion

Mesh grille() {
    MeshBuilder builder("grille");
    constexpr int bars = 28;
    constexpr float spacing = 0.2f, end = 0.5f * spacing * bars;
    for (int i = 0; i < bars; ++i) {
        const float x = spacing * (static_cast<float>(i) + 0.5f) - end;
        const float half = i % 2 == 0 ? 0.012f : 0.03f;
        builder.box({x - half, 0.1f, -half}, {x + half, 2.1f, half});
    }
    for (const float y : {0.1f, 2.05f}) builder.box({-end, y, -0.02f}, {end, y + 0.05f, 0.02f});
    return builder.take();
}

// --- lab-lights

constexpr vec3 hallLower{-6.0f, 0.0f, -9.0f}, hallUpper{6.0f, 4.0f, 6.0f};
constexpr uint16_t lightColors = 8;

/// Saturated colours with evenly spaced hues.
vec3 lightColor(uint16_t index) {
    const float hue = 2.0f * pi * static_cast<float>(index) / float{lightColors};
    const auto part = [&](float phase) { return 0.5f + 0.48f * std::cos(hue - phase); };
    return {part(0.0f), part(2.0f * pi / 3.0f), part(4.0f * pi / 3.0f)};
}

/// 12 x 10 on the ceiling, 2 x 25 on each long wall: 220. Neighbours have similar colours; otherwise all
/// would mix to white everywhere.
Mesh hallLights() {
    MeshBuilder builder("lights");
    Sequence random;
    constexpr float half = 0.09f, gap = 0.01f;
    for (int row = 0; row < 12; ++row) {
        for (int column = 0; column < 10; ++column) {
            const vec3 center(-4.95f + 1.1f * static_cast<float>(column), hallUpper.y - gap,
                              -8.2f + 1.2f * static_cast<float>(row));
            const auto color = static_cast<uint16_t>(
                static_cast<uint16_t>(0.6f * static_cast<float>(row) + random.next(0.0f, 1.9f)) %
                lightColors);
            addLamp(builder, center, half, half, color);
        }
    }
    for (int i = 0; i < 100; ++i) {
        const bool isLeft = i % 2 == 0;
        const vec3 center(isLeft ? hallLower.x + gap : hallUpper.x - gap, i % 4 < 2 ? 1.2f : 2.4f,
                          -8.6f + 0.58f * static_cast<float>(i / 4));
        const vec3 along(0.0f, 0.0f, isLeft ? -half : half), up(0.0f, half, 0.0f);
        const auto color = static_cast<uint16_t>(random.next(isLeft ? 0.0f : 4.0f, isLeft ? 1.99f : 5.99f));
        builder.quad(center - along - up, center + along - up, center + along + up, center - along + up,
                     color);
    }
    return builder.take();
}

}  // namespace

Scene labLightScene() {
    Scene scene = studio("lab-light");
    const int key = addMovingLamp(scene, vec3(19.0f, 17.0f, 14.0f));
    constexpr float y = studioHeight - 0.01f;
    addClip(scene, {"sliding",
                    {{key,
                      AnimatedValue::Translation,
                      Interpolation::Linear,
                      3,
                      {0.0f, labChangeTime, 4.0f},
                      {-1.7f, y, -0.9f, 1.5f, y, -0.9f, 1.5f, y, -0.9f}}}});
    return scene;
}

Scene labSwitchScene() {
    Scene scene = studio("lab-switch");
    const int key = addMovingLamp(scene, vec3(22.0f, 15.0f, 8.0f));
    scene.materials.push_back(emitter("fill", vec3(0.5f), {5.0f, 8.0f, 13.0f}));
    MeshBuilder fill("fill");
    addLamp(fill, {1.5f, studioHeight - 0.01f, -0.9f}, 0.4f, 0.25f, 0);
    addMesh(scene, fill.take(), static_cast<int>(scene.materials.size() - 1));
    constexpr float y = studioHeight - 0.01f;
    addClip(scene, {"switching",
                    {{key,
                      AnimatedValue::Translation,
                      Interpolation::Step,
                      3,
                      {0.0f, labChangeTime, 4.0f},
                      {-1.5f, y, -0.9f, -1.5f, y + 0.5f, -0.9f, -1.5f, y + 0.5f, -0.9f}}}});
    return scene;
}

Scene labDisocclusionScene() {
    Scene scene;
    scene.name = "lab-disocclusion";
    scene.materials = {
        lambertian("plain", vec3(0.7f)),
        textured(lambertian("bricks", vec3(1.0f)), addTexture(scene, brickTexture(), 0.5f)),
        textured(lambertian("tiles", vec3(1.0f)),
                 addTexture(scene, checkerTexture(4, {0.85f, 0.83f, 0.78f}, {0.3f, 0.4f, 0.42f}), 0.5f)),
        lambertian("block", {0.2f, 0.45f, 0.5f}),
        emitter("light", vec3(0.5f), vec3(13.0f)),
        lambertian("grille", {0.16f, 0.15f, 0.14f})};
    MeshBuilder room("room");
    room.box({-3.8f, 0.0f, -3.2f}, {3.8f, 3.0f, 3.2f}, {0, 0, 2, 0, 1, 0}, true);
    addBlock(room, {-1.2f, -1.6f}, {0.4f, 0.4f}, 1.1f, 0.5f, 3);
    addBlock(room, {1.1f, -1.2f}, {0.3f, 0.5f}, 0.7f, -0.4f, 0);
    addLamp(room, {0.0f, 2.99f, -1.2f}, 1.2f, 0.5f, 4);
    Mesh roomMesh = room.take();
    addWallpaperCoordinates(roomMesh);
    addMesh(scene, std::move(roomMesh), 0);
    const int bars = addNode(scene, addMesh(scene, grille(), 5));
    constexpr float z = 0.7f;
    addClip(scene, {"back and forth",
                    {{bars,
                      AnimatedValue::Translation,
                      Interpolation::Linear,
                      3,
                      {0, 1, 2, 3, 4},
                      {-0.75f, 0, z, 0.75f, 0, z, -0.75f, 0, z, 0.75f, 0, z, -0.75f, 0, z}}}});
    addCamera(scene, {0.0f, 1.5f, 2.9f}, {0.0f, 1.1f, -0.5f}, 0.95f);
    return scene;
}

Scene labLightsScene() {
    Scene scene;
    scene.name = "lab-lights";
    scene.materials = {lambertian("wall", vec3(0.6f)), glossy("floor", vec3(0.35f), 0.0f, 0.3f),
                       lambertian("chalk", vec3(0.75f)), glossy("steel", vec3(0.8f), 1.0f, 0.25f),
                       glossy("lacquer", {0.5f, 0.12f, 0.1f}, 0.0f, 0.15f)};
    MeshBuilder hall("hall");
    hall.box(hallLower, hallUpper, {0, 0, 1, 0, 0, 0}, true);
    Sequence random;
    for (int row = 0; row < 5; ++row) {
        for (int column = 0; column < 6; ++column) {
            const vec2 center(-4.5f + 1.8f * static_cast<float>(column) + random.next(-0.25f, 0.25f),
                              -7.0f + 2.1f * static_cast<float>(row) + random.next(-0.3f, 0.3f));
            const vec2 halfSize(random.next(0.2f, 0.45f), random.next(0.2f, 0.45f));
            addBlock(hall, center, halfSize, random.next(0.4f, 1.9f), random.next(-0.7f, 0.7f),
                     static_cast<uint16_t>(2 + (row + column) % 3));
        }
    }
    addMesh(scene, hall.take(), 0);
    const auto firstLight = static_cast<int>(scene.materials.size());
    for (uint16_t i = 0; i < lightColors; ++i)
        scene.materials.push_back(emitter("light " + std::to_string(i), vec3(0.5f), 9.0f * lightColor(i)));
    addMesh(scene, hallLights(), firstLight);
    addCamera(scene, {0.4f, 2.2f, 5.6f}, {0.0f, 1.3f, -2.0f}, 1.0f);
    return scene;
}

}  // namespace limpid::scene
