#include "scene/builtin/random_room.h"

#include <algorithm>
#include <vector>

#include "scene/builtin/mesh_builder.h"
#include "scene/builtin/random_scene.h"
#include "scene/lights/environment.h"

namespace limpid::scene {
namespace {

/// A place on the floor that is occupied.
struct Place {
    vec2 center;
    float radius;
};

class RandomRoom : RandomScene {
  public:
    explicit RandomRoom(uint32_t seed) : RandomScene("room", seed) {}

    Scene make() {
        half_ = {random_.next(1.5f, 4.5f), random_.next(1.5f, 4.5f)};
        height_ = random_.next(2.3f, 4.0f);
        isOpen_ = chance(0.15f);
        hasWindow_ = !isOpen_ && chance(0.25f);
        addRoom();
        if (isOpen_ || hasWindow_) addSky();
        if (!isOpen_) addLamps();
        if (chance(0.3f)) addGlowingBalls();
        placeCamera();
        const int things = whole(5, 30);
        for (int i = 0; i < things; ++i) addThing();
        return std::move(scene_);
    }

  private:
    Material wallMaterial() {
        Material wall = chance(0.7f) ? lambertian("wall", color(0.3f, 0.85f))
                                     : roughened(glossy("wall", color(0.1f, 0.8f), 0.0f, 0.0f), 0.1f);
        return chance(0.35f) ? patterned(std::move(wall), 0.25f, 1.5f) : wall;
    }

    /// Adds the walls, with one material per side. The side towards +Z may have an opening.
    void addRoom() {
        enum Side : uint16_t { Left, Right, Floor, Ceiling, Back, Front };
        const int first = static_cast<int>(scene_.materials.size());
        for (int side = 0; side < 6; ++side) addMaterial(wallMaterial());
        const float x = half_.x, z = half_.y, y = height_;
        MeshBuilder room("room");
        room.quad({-x, 0, z}, {-x, 0, -z}, {-x, y, -z}, {-x, y, z}, Left);
        room.quad({x, 0, -z}, {x, 0, z}, {x, y, z}, {x, y, -z}, Right);
        room.quad({-x, 0, z}, {x, 0, z}, {x, 0, -z}, {-x, 0, -z}, Floor);
        if (!isOpen_) room.quad({-x, y, -z}, {x, y, -z}, {x, y, z}, {-x, y, z}, Ceiling);
        room.quad({-x, 0, -z}, {x, 0, -z}, {x, y, -z}, {-x, y, -z}, Back);
        if (hasWindow_)
            addWallWithWindow(room, Front);
        else
            room.quad({x, 0, z}, {-x, 0, z}, {-x, y, z}, {x, y, z}, Front);
        Mesh mesh = room.take();
        addWallpaperCoordinates(mesh);
        addMesh(scene_, std::move(mesh), first);
    }

    void addWallWithWindow(MeshBuilder& room, uint16_t slot) {
        const float z = half_.y, width = random_.next(0.4f, 0.9f) * half_.x;
        const float low = random_.next(0.3f, 1.0f), high = random_.next(1.6f, height_ - 0.2f);
        const auto part = [&](float left, float right, float bottom, float top) {
            room.quad({right, bottom, z}, {left, bottom, z}, {left, top, z}, {right, top, z}, slot);
        };
        part(-half_.x, -width, 0.0f, height_);
        part(width, half_.x, 0.0f, height_);
        part(-width, width, 0.0f, low);
        part(-width, width, high, height_);
    }

    void addSky() {
        scene_.environment = softSky();
        const float strength = random_.next(0.5f, 4.0f);
        const vec3 tint = strength * lightColor();
        for (vec3& radiance : scene_.environment.radiance) radiance *= tint;
        if (!chance(0.4f)) return;
        PunctualLight sun;
        sun.kind = PunctualLight::Kind::Directional;
        const vec3 travels{random_.next(-1.0f, 1.0f), random_.next(-2.0f, -0.3f), random_.next(-1.5f, 0.2f)};
        sun.direction = glm::normalize(travels);
        const float illuminance = random_.next(2.0f, 15.0f);
        sun.intensity = illuminance * glm::mix(vec3(1.0f), lightColor(), 0.5f);
        sun.name = "sun";
        scene_.lights.push_back(sun);
    }

    /// Scales the lamps so that a square metre of floor gets about the same light, whatever their number and
    /// size.
    void addLamps() {
        const int count = whole(1, chance(0.2f) ? 24 : 5);
        const float brightness =
            random_.next(0.5f, 4.0f) * half_.x * half_.y * 4.0f / static_cast<float>(count);
        for (int i = 0; i < count; ++i) {
            const vec2 size{random_.next(0.05f, 0.25f) * half_.x, random_.next(0.05f, 0.25f) * half_.y};
            const vec3 center{random_.next(-0.75f, 0.75f) * half_.x, height_ - random_.next(0.01f, 0.4f),
                              random_.next(-0.75f, 0.75f) * half_.y};
            const vec3 radiance = lightColor() * (brightness / (4.0f * size.x * size.y));
            MeshBuilder lamp("lamp");
            addLamp(lamp, center, size.x, size.y, 0);
            addMesh(scene_, lamp.take(), addMaterial(emitter("lamp", vec3(0.5f), radiance)));
        }
    }

    void addGlowingBalls() {
        const int count = whole(1, 4);
        for (int i = 0; i < count; ++i) {
            const float radius = random_.next(0.04f, 0.2f);
            const vec3 center{random_.next(-0.85f, 0.85f) * half_.x, random_.next(0.4f, 0.9f) * height_,
                              random_.next(-0.85f, 0.85f) * half_.y};
            MeshBuilder ball("ball", true);
            ball.sphere(center, radius, 16, 10);
            const float strength = random_.next(0.2f, 1.0f);
            const vec3 radiance = lightColor() * (strength / (radius * radius));
            addMesh(scene_, ball.take(), addMaterial(emitter("ball", vec3(0.5f), radiance)));
        }
    }

    void placeCamera() {
        const float side = chance(0.5f) ? 1.0f : -1.0f;
        const vec3 eye{side * random_.next(0.2f, 0.85f) * half_.x, random_.next(0.7f, 0.75f * height_),
                       random_.next(0.35f, 0.9f) * half_.y};
        const vec3 target{-side * random_.next(-0.2f, 0.6f) * half_.x, random_.next(0.2f, 0.6f) * height_,
                          -random_.next(0.0f, 0.9f) * half_.y};
        addCamera(scene_, eye, target, random_.next(0.6f, 1.3f));
        places_.push_back({{eye.x, eye.z}, 0.35f});
    }

    /// Finds a free place on the floor; returns false if there is none.
    bool findPlace(float radius, vec2& center) {
        constexpr int attempts = 12;
        for (int i = 0; i < attempts; ++i) {
            center = {random_.next(-1.0f, 1.0f) * (half_.x - radius),
                      random_.next(-1.0f, 1.0f) * (half_.y - radius)};
            const bool isFree = std::ranges::all_of(places_, [&](const Place& place) {
                return glm::distance(place.center, center) > place.radius + radius;
            });
            if (!isFree) continue;
            places_.push_back({center, radius});
            return true;
        }
        return false;
    }

    void addThing() {
        const float radius = random_.next(0.1f, 0.6f);
        const int kind = whole(0, 5);
        vec2 center;
        if (radius > 0.4f * std::min(half_.x, half_.y) || !findPlace(radius, center)) return;
        switch (kind) {
            case 0:
                return addBall(center, radius);
            case 1:
                return addRing(center, radius);
            case 2:
                return addTable(center, radius);
            default:
                return addColumn(center, radius);
        }
    }

    void addFlat(MeshBuilder& builder, bool mayBeGlass) {
        Mesh mesh = builder.take();
        addWallpaperCoordinates(mesh);
        Material material = anyMaterial(mayBeGlass);
        if (chance(0.3f) && material.transmission == 0.0f)
            material = patterned(std::move(material), 0.5f, 3.0f);
        addMesh(scene_, std::move(mesh), addMaterial(std::move(material)));
    }

    void addBall(const vec2& center, float radius) {
        MeshBuilder ball("ball", true);
        const float lift = chance(0.3f) ? random_.next(0.0f, 0.5f * height_) : 0.0f;
        ball.sphere({center.x, std::min(radius + 0.002f + lift, height_ - radius - 0.5f), center.y}, radius,
                    48, 24);
        addMesh(scene_, ball.take(), addMaterial(anyMaterial(true)));
    }

    void addRing(const vec2& center, float radius) {
        MeshBuilder ring("ring", true);
        const float tube = random_.next(0.1f, 0.35f) * radius;
        ring.torus({center.x, tube + random_.next(0.002f, 0.8f), center.y}, radius - tube, tube, 48, 20);
        addMesh(scene_, ring.take(), addMaterial(anyMaterial(true)));
    }

    void addTable(const vec2& center, float radius) {
        const float height = random_.next(0.4f, 1.1f), side = 0.7f * radius, leg = random_.next(0.02f, 0.05f);
        MeshBuilder table("table");
        const vec3 middle(center.x, 0.0f, center.y);
        table.box(middle + vec3(-side, height - 0.04f, -side), middle + vec3(side, height, side));
        for (const float x : {-1.0f, 1.0f}) {
            for (const float z : {-1.0f, 1.0f}) {
                const vec3 foot = middle + vec3(x * (side - leg), 0.0f, z * (side - leg));
                table.box(foot - vec3(leg, 0.0f, leg), foot + vec3(leg, height - 0.04f, leg));
            }
        }
        addFlat(table, false);
        if (!chance(0.6f)) return;
        MeshBuilder ball("ball", true);
        const float size = random_.next(0.1f, 0.45f) * side;
        ball.sphere(middle + vec3(0.0f, height + size + 0.002f, 0.0f), size, 48, 24);
        addMesh(scene_, ball.take(), addMaterial(anyMaterial(true)));
    }

    void addColumn(const vec2& center, float radius) {
        const vec2 share{random_.next(0.3f, 0.7f), random_.next(0.3f, 0.7f)};
        const float height = random_.next(0.1f, 0.8f * height_), angle = random_.next(0.0f, pi);
        MeshBuilder block("block");
        addBlock(block, center, radius * share, height, angle, 0);
        addFlat(block, false);
    }

    vec2 half_{0.0f};  ///< half of the floor's width and depth
    float height_ = 0.0f;
    bool isOpen_ = false, hasWindow_ = false;
    std::vector<Place> places_;
};

}  // namespace

Scene randomRoom(uint32_t seed) {
    return RandomRoom(seed).make();
}

}  // namespace limpid::scene
