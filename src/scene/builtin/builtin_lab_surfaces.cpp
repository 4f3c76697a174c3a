// The lab's scenes about surfaces: lab-mirror and lab-textures.
#include <cmath>

#include "scene/builtin/builtin_lab.h"
#include "scene/builtin/builtin_parts.h"
#include "scene/builtin/mesh_builder.h"
#include "scene/builtin/procedural_textures.h"
#include "scene/model/camera.h"

namespace limpid::scene {
namespace {

/// The desk's picture is 1.3 m x 1 m and tilted so that it faces the mirror and the camera equally.
MirrorLab makeMirrorLab() {
    constexpr float halfWidth = 0.65f, halfDepth = 0.5f, height = 0.6f;
    const float tilt = glm::radians(15.0f);
    const vec3 center(0.0f, height, 0.0f), right(halfWidth, 0.0f, 0.0f);
    const vec3 top = halfDepth * vec3(0.0f, -std::sin(tilt), -std::cos(tilt));
    MirrorLab lab;
    lab.panelCorners = {center - right + top, center + right + top, center + right - top,
                        center - right - top};
    lab.mirrorLower = {-2.2f, 0.15f, -0.62f};
    lab.mirrorUpper = {2.5f, 2.05f, -0.62f};
    lab.mirrorPoint = 0.5f * (lab.mirrorLower + lab.mirrorUpper);
    lab.mirrorNormal = {0.0f, 0.0f, 1.0f};
    return lab;
}

/// Adds the picture, on a board with a foot.
void addDesk(Scene& scene, const MirrorLab& lab, int pictureMaterial, int woodMaterial) {
    const auto& [topLeft, topRight, bottomRight, bottomLeft] = lab.panelCorners;
    MeshBuilder picture("picture");
    picture.quad(bottomLeft, bottomRight, topRight, topLeft);
    Mesh mesh = picture.take();
    mesh.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    addMesh(scene, std::move(mesh), pictureMaterial);

    const vec3 down = -glm::normalize(glm::cross(topRight - topLeft, topLeft - bottomLeft));
    const auto lower = [&](const vec3& corner, float depth) { return corner + depth * down; };
    MeshBuilder desk("desk");
    const vec3 around[] = {bottomLeft, bottomRight, topRight, topLeft};
    for (size_t i = 0; i < 4; ++i) {
        const vec3 &a = around[i], &b = around[(i + 1) % 4];
        desk.quad(lower(a, 0.04f), lower(b, 0.04f), b, a);
    }
    desk.quad(lower(topLeft, 0.04f), lower(topRight, 0.04f), lower(bottomRight, 0.04f),
              lower(bottomLeft, 0.04f));
    desk.box({-0.3f, 0.0f, -0.2f}, {0.3f, 0.5f, 0.2f});
    addMesh(scene, desk.take(), woodMaterial);
}

/// Adds the mirror: one rectangle in front of a frame.
void addStandingMirror(Scene& scene, const MirrorLab& lab, int mirrorMaterial, int frameMaterial) {
    const vec3 &low = lab.mirrorLower, &high = lab.mirrorUpper;
    MeshBuilder mirror("mirror");
    mirror.quad(low, {high.x, low.y, low.z}, high, {low.x, high.y, low.z});
    addMesh(scene, mirror.take(), mirrorMaterial);
    constexpr float rim = 0.05f;
    MeshBuilder frame("frame");
    frame.box({low.x - rim, 0.0f, low.z - 0.08f}, {high.x + rim, high.y + rim, low.z - 0.005f});
    addMesh(scene, frame.take(), frameMaterial);
}

/// Adds texture coordinates for MeshBuilder::sphere's vertices: `repeats` times around and down.
void addSphereCoordinates(Mesh& mesh, uint32_t segments, uint32_t rings, const vec2& repeats) {
    for (uint32_t ring = 0; ring <= rings; ++ring) {
        for (uint32_t segment = 0; segment <= segments; ++segment) {
            mesh.uv0.push_back(repeats * vec2(static_cast<float>(segment) / static_cast<float>(segments),
                                              static_cast<float>(ring) / static_cast<float>(rings)));
        }
    }
}

void addDentedBall(Scene& scene) {
    constexpr uint32_t segments = 20, rings = 10;
    Material copper = glossy("dented copper", {0.95f, 0.64f, 0.54f}, 1.0f, 0.3f);
    copper.normalTexture = addTexture(scene, hammeredNormalTexture());
    scene.materials.push_back(copper);
    MeshBuilder builder("ball", true);
    builder.sphere({0.35f, 0.5f, -0.6f}, 0.5f, segments, rings);
    Mesh mesh = builder.take();
    addSphereCoordinates(mesh, segments, rings, {2.0f, 1.0f});
    addMesh(scene, std::move(mesh), static_cast<int>(scene.materials.size() - 1));
}

enum SurfaceSlot : uint16_t { Plain, Bricks, Checker, Plaster, Wood, Worn, SurfaceLight };

std::vector<Material> surfaces(Scene& scene) {
    Material bricks = textured(lambertian("bricks", vec3(1.0f)), addTexture(scene, brickTexture(), 0.7f));
    bricks.normalTexture = addTexture(scene, brickNormalTexture(), 0.7f);
    Material worn = glossy("worn steel", {0.75f, 0.75f, 0.78f}, 1.0f, 1.0f);
    worn.metallicRoughnessTexture = addTexture(scene, wornRoughnessTexture(0.18f, 0.55f), 0.6f);
    const TextureRef checker = addTexture(scene, checkerTexture(8, {0.9f, 0.87f, 0.8f}, {0.2f, 0.3f, 0.42f}));
    const TextureRef plaster =
        addTexture(scene, noiseTexture(6, {0.55f, 0.6f, 0.52f}, {0.88f, 0.9f, 0.82f}), 0.5f);
    return {lambertian("plain", vec3(0.75f)),
            bricks,
            textured(lambertian("checker", vec3(1.0f)), checker),
            textured(lambertian("plaster", vec3(1.0f)), plaster),
            textured(glossy("wood", vec3(1.0f), 0.0f, 0.4f), addTexture(scene, woodTexture(), 0.45f)),
            worn,
            emitter("light", vec3(0.5f), {8.0f, 7.5f, 6.7f})};
}

}  // namespace

vec3 MirrorLab::reflected(const vec3& point) const {
    return point - 2.0f * glm::dot(point - mirrorPoint, mirrorNormal) * mirrorNormal;
}

const MirrorLab& mirrorLab() {
    static const MirrorLab lab = makeMirrorLab();
    return lab;
}

Scene labMirrorScene() {
    Scene scene;
    scene.name = "lab-mirror";
    enum Slot : uint16_t { Wall, Floor, Light, Block, Back };
    const TextureRef tiles =
        addTexture(scene, checkerTexture(2, {0.42f, 0.4f, 0.38f}, {0.34f, 0.33f, 0.33f}), 0.8f);
    scene.materials = {lambertian("wall", {0.7f, 0.68f, 0.64f}),
                       textured(glossy("floor", vec3(1.0f), 0.0f, 0.15f), tiles),
                       emitter("light", vec3(0.5f), {6.0f, 5.6f, 5.0f}),
                       lambertian("block", {0.2f, 0.45f, 0.48f}),
                       lambertian("back", {0.6f, 0.3f, 0.2f}),
                       textured(lambertian("picture", vec3(1.0f)), addTexture(scene, testPictureTexture())),
                       lambertian("wood", {0.32f, 0.2f, 0.12f}),
                       glossy("mirror", vec3(0.95f), 1.0f, 0.0f)};
    // Wide enough for a camera that orbits the desk from -66 to 78 degrees, and placed so that its centre,
    // which camera paths orbit around, is above the desk in the camera's view.
    MeshBuilder room("room");
    room.box({-3.5f, 0.0f, -4.0f}, {4.75f, 3.2f, 3.0f}, {Wall, Wall, Floor, Wall, Back, Wall}, true);
    // Large lamps: a mirror's caustics of small ones would take too many samples to converge.
    addLamp(room, {-1.2f, 3.19f, 1.0f}, 1.3f, 1.0f, Light);
    addLamp(room, {2.6f, 3.19f, -2.0f}, 1.0f, 1.0f, Light);
    addBlock(room, {-2.3f, -2.6f}, {0.4f, 0.4f}, 2.6f, 0.3f, Block);
    addBlock(room, {0.8f, -3.0f}, {0.6f, 0.3f}, 2.4f, -0.2f, Wall);
    addBlock(room, {3.6f, -0.9f}, {0.35f, 0.35f}, 0.9f, 0.5f, Block);
    Mesh mesh = room.take();
    addWallpaperCoordinates(mesh);
    addMesh(scene, std::move(mesh), 0);
    addDesk(scene, mirrorLab(), 5, 6);
    addStandingMirror(scene, mirrorLab(), 7, 6);
    const float elevation = glm::radians(30.0f), azimuth = glm::radians(-66.0f);
    const vec3 target(0.0f, 0.6f, -0.5f);
    const vec3 towardsEye(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                          std::cos(elevation) * std::cos(azimuth));
    addCamera(scene, target + 3.8f * towardsEye, target, glm::radians(42.0f));
    return scene;
}

Scene labTexturesScene() {
    Scene scene;
    scene.name = "lab-textures";
    scene.materials = surfaces(scene);
    MeshBuilder room("room");
    room.box({-2.2f, 0.0f, -4.5f}, {2.2f, 2.7f, 3.0f}, {Bricks, Checker, Wood, Plain, Plaster, Plain}, true);
    addLamp(room, {0.0f, 2.69f, 0.2f}, 0.8f, 0.7f, SurfaceLight);
    addLamp(room, {0.0f, 2.69f, -3.0f}, 0.8f, 0.7f, SurfaceLight);
    addBlock(room, {-1.0f, -2.0f}, {0.45f, 0.45f}, 1.3f, 0.5f, Worn);
    addBlock(room, {1.35f, -2.4f}, {0.3f, 0.5f}, 0.8f, -0.3f, Wood);
    addBlock(room, {-1.1f, 0.2f}, {0.25f, 0.25f}, 0.45f, 0.8f, Plaster);
    addBlock(room, {1.3f, 0.3f}, {0.2f, 0.2f}, 0.6f, 0.2f, Bricks);
    Mesh mesh = room.take();
    addWallpaperCoordinates(mesh);
    addMesh(scene, std::move(mesh), 0);
    addDentedBall(scene);
    addCamera(scene, {-0.3f, 1.25f, 2.8f}, {0.1f, 0.9f, -1.5f}, 1.0f);
    return scene;
}

}  // namespace limpid::scene
