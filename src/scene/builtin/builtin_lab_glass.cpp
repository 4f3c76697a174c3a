// The lab's scene about smooth glass: lab-glass.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "scene/builtin/builtin_lab.h"
#include "scene/builtin/builtin_parts.h"
#include "scene/builtin/mesh_builder.h"
#include "scene/builtin/procedural_textures.h"

namespace limpid::scene {
namespace {

constexpr float tableHeight = 0.75f;

Material smoothGlass(std::string name, float ior, bool thin) {
    Material glass = glossy(std::move(name), vec3(1.0f), 0.0f, 0.0f);
    glass.transmission = 1.0f;
    glass.ior = ior;
    glass.thin = thin;
    glass.doubleSided = thin;
    return glass;
}

/// Revolves an outline (radius, height) about the vertical line through `foot`. The outline goes from the
/// bottom to the top of a body, for fronts outside, and starts and ends on the line.
Mesh revolved(std::string name, const vec3& foot, std::span<const vec2> outline, uint32_t segments) {
    Mesh mesh;
    mesh.name = std::move(name);
    for (size_t i = 0; i < outline.size(); ++i) {
        const vec2 before = outline[i > 0 ? i - 1 : 0], after = outline[std::min(i + 1, outline.size() - 1)];
        const vec2 slope = glm::normalize(after - before);
        for (uint32_t segment = 0; segment < segments; ++segment) {
            const float phi = 2.0f * pi * static_cast<float>(segment) / static_cast<float>(segments);
            const vec3 outward(std::cos(phi), 0.0f, -std::sin(phi));
            mesh.positions.push_back(foot + outline[i].x * outward + vec3(0.0f, outline[i].y, 0.0f));
            mesh.normals.push_back(outline[i].x > 0.0f ? slope.y * outward - vec3(0.0f, slope.x, 0.0f)
                                                       : vec3(0.0f, i == 0 ? -1.0f : 1.0f, 0.0f));
        }
    }
    const auto face = [&](uint32_t a, uint32_t b, uint32_t c) {
        mesh.indices.insert(mesh.indices.end(), {a, b, c});
    };
    const auto rings = static_cast<uint32_t>(outline.size());
    for (uint32_t ring = 0; ring + 1 < rings; ++ring) {
        for (uint32_t segment = 0; segment < segments; ++segment) {
            const uint32_t a = ring * segments + segment, b = ring * segments + (segment + 1) % segments;
            const uint32_t c = a + segments, d = b + segments;
            if (outline[ring].x > 0.0f) face(a, b, d);
            if (outline[ring + 1].x > 0.0f) face(a, d, c);
        }
    }
    return mesh;
}

/// A bottle's outline, `inset` within the glass: of its inner wall, or of the liquid, which ends at `top`.
std::vector<vec2> bottleOutline(float inset, float top) {
    constexpr vec2 outer[] = {{0.085f, 0.0f}, {0.1f, 0.015f},  {0.1f, 0.2f},   {0.093f, 0.24f},
                              {0.06f, 0.28f}, {0.036f, 0.31f}, {0.032f, 0.4f}, {0.03f, 0.405f}};
    std::vector<vec2> outline{{0.0f, inset}};
    for (const vec2& point : outer) {
        if (point.y + inset > top) break;
        outline.push_back({point.x - inset, std::max(point.y, inset)});
    }
    const float rim = outline.back().x;
    if (outline.back().y < top - 1e-4f) outline.push_back({rim, top});
    outline.push_back({0.0f, top});
    return outline;
}

/// Glass with a hollow, and in it a green liquid that does not quite touch it.
void addBottle(Scene& scene, const vec3& foot, int glass, int liquid) {
    constexpr uint32_t segments = 40;
    addMesh(scene, revolved("bottle", foot, bottleOutline(0.0f, 0.405f), segments), glass);
    Mesh hollow = revolved("hollow", foot, bottleOutline(0.008f, 0.38f), segments);
    for (vec3& normal : hollow.normals) normal = -normal;
    for (size_t i = 0; i < hollow.indices.size(); i += 3) std::swap(hollow.indices[i], hollow.indices[i + 1]);
    addMesh(scene, std::move(hollow), glass);
    addMesh(scene, revolved("liquid", foot, bottleOutline(0.009f, 0.19f), segments), liquid);
}

/// A pane in a frame, upright, facing the camera.
void addWindow(Scene& scene, const vec3& centre, const vec2& half, int pane, int wood) {
    MeshBuilder glass("window");
    const vec3 right(half.x, 0.0f, 0.0f), up(0.0f, half.y, 0.0f);
    glass.quad(centre - right - up, centre + right - up, centre + right + up, centre - right + up);
    addMesh(scene, glass.take(), pane);
    constexpr float bar = 0.03f;
    MeshBuilder frame("frame");
    for (const float side : {-1.0f, 1.0f}) {
        const vec3 post = centre + side * right, beam = centre + side * up;
        frame.box(post - vec3(bar, half.y + bar, bar), post + vec3(bar, half.y + bar, bar));
        frame.box(beam - vec3(half.x - bar, bar, bar), beam + vec3(half.x - bar, bar, bar));
    }
    addMesh(scene, frame.take(), wood);
}

}  // namespace

Scene labGlassScene() {
    Scene scene;
    scene.name = "lab-glass";
    enum Slot : uint16_t { Plaster, Checker, Bricks, Wood, Lamp, Paint, Glass, Pane, Liquid };
    const TextureRef checker =
        addTexture(scene, checkerTexture(4, {0.85f, 0.83f, 0.78f}, {0.2f, 0.3f, 0.42f}));
    scene.materials = {lambertian("plaster", vec3(0.72f)),
                       textured(lambertian("checker", vec3(1.0f)), checker),
                       textured(lambertian("bricks", vec3(1.0f)), addTexture(scene, brickTexture(), 0.7f)),
                       textured(lambertian("wood", vec3(1.0f)), addTexture(scene, woodTexture(), 0.45f)),
                       emitter("lamp", vec3(0.5f), {7.0f, 6.6f, 6.0f}),
                       lambertian("paint", {0.6f, 0.2f, 0.12f}),
                       smoothGlass("glass", 1.5f, false),
                       smoothGlass("pane", 1.5f, true),
                       smoothGlass("liquid", 1.33f, false)};
    scene.materials.back().absorption = {9.0f, 2.0f, 14.0f};
    MeshBuilder room("room");
    room.box({-2.2f, 0.0f, -2.6f}, {2.2f, 2.7f, 2.6f}, {Paint, Plaster, Plaster, Plaster, Checker, Bricks},
             true);
    addLamp(room, {-0.3f, 2.69f, 0.3f}, 0.7f, 0.5f, Lamp);
    room.box({-1.3f, 0.0f, -0.45f}, {0.45f, tableHeight, 0.45f}, Wood);
    addBlock(room, {1.4f, -1.9f}, {0.25f, 0.25f}, 1.5f, 0.4f, Bricks);
    Mesh mesh = room.take();
    addWallpaperCoordinates(mesh);
    addMesh(scene, std::move(mesh), 0);
    MeshBuilder ball("ball", true);
    ball.sphere({-0.75f, tableHeight + 0.27f, 0.05f}, 0.27f, 64, 32);
    addMesh(scene, ball.take(), Glass);
    addBottle(scene, {0.05f, tableHeight, 0.1f}, Glass, Liquid);
    addWindow(scene, {1.15f, 1.2f, -0.6f}, {0.6f, 0.7f}, Pane, Wood);
    addCamera(scene, {0.15f, 1.35f, 2.3f}, {0.05f, 1.05f, -0.4f}, 0.85f);
    return scene;
}

}  // namespace limpid::scene
