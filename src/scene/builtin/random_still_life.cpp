#include "scene/builtin/random_still_life.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/builtin/mesh_builder.h"
#include "scene/builtin/procedural_textures.h"
#include "scene/builtin/random_scene.h"
#include "scene/lights/environment.h"

namespace limpid::scene {
namespace {

/// Adds texture coordinates to meshes with normals: a projection along a slanted axis, which has no seam.
void addSlantedCoordinates(Mesh& mesh) {
    for (const vec3& p : mesh.positions)
        mesh.uv0.emplace_back(p.x + 0.37f * p.y, 0.21f * p.x + p.z + 0.83f * p.y);
}

class RandomStillLife : RandomScene {
  public:
    explicit RandomStillLife(uint32_t seed) : RandomScene("still-life", seed) {}

    Scene make() {
        reach_ = random_.next(0.3f, 1.2f);
        const int things = whole(1, 14);
        size_ = reach_ * random_.next(0.5f, 1.2f) / std::cbrt(static_cast<float>(things));
        addSupport();
        for (int i = 0; i < things; ++i) addThing();
        addSurroundings();
        addLights();
        placeCamera();
        return std::move(scene_);
    }

  private:
    vec3 strongly(float least, float most, const vec3& light) { return logarithmic(least, most) * light; }

    /// Adds the surface that objects stand on, at height 0.
    void addSupport() {
        const float kind = random_.next(0.0f, 1.0f);
        if (kind > 0.65f) return;
        stands_ = true;
        const bool isGround = kind < 0.5f;
        const float half = isGround ? 25.0f : 1.5f * reach_;
        MeshBuilder builder("support");
        builder.box({-half, isGround ? -0.1f : -reach_, -half}, {half, 0.0f, half});
        addFlat(builder, 0.5f);
    }

    Texture collage() {
        constexpr uint32_t size = 256;
        Texture texture{"collage", size, size, std::vector<uint8_t>(size_t{4} * size * size, 255), true, {}};
        const int parts = whole(20, 200);
        for (int i = 0; i < parts; ++i) {
            const float large = i == 0 ? size : logarithmic(2.0f, 0.5f * size);
            const float slender = i == 0 ? 1.0f : logarithmic(0.05f, 1.0f);
            const uvec2 extent{static_cast<uint32_t>(large), static_cast<uint32_t>(large * slender) + 1};
            const uvec2 first{static_cast<uint32_t>(whole(0, size - 1)),
                              static_cast<uint32_t>(whole(0, size - 1))};
            const vec3 shade = 255.0f * color(0.02f, 1.0f);
            const bool isDisc = chance(0.3f), isUpright = chance(0.5f);
            paint(texture, first, isUpright ? uvec2(extent.y, extent.x) : extent, shade, isDisc);
        }
        return texture;
    }

    /// Paints a rectangle, or the ellipse in it, wrapping around at the edges.
    static void paint(Texture& texture, const uvec2& first, const uvec2& extent, const vec3& shade,
                      bool isDisc) {
        for (uint32_t y = 0; y < extent.y; ++y) {
            for (uint32_t x = 0; x < extent.x; ++x) {
                const vec2 p = 2.0f * (vec2(x, y) + 0.5f) / vec2(extent) - 1.0f;
                if (isDisc && glm::dot(p, p) > 1.0f) continue;
                const size_t at = size_t{4} * ((first.y + y) % texture.height * texture.width +
                                               (first.x + x) % texture.width);
                for (int c = 0; c < 3; ++c)
                    texture.rgba[at + static_cast<size_t>(c)] = static_cast<uint8_t>(shade[c]);
            }
        }
    }

    Material pictured(Material material) {
        material.baseColor = vec4(1.0f);
        const Texture texture = chance(0.6f) ? collage() : pattern();
        const float repeats = logarithmic(0.5f, 8.0f);
        return textured(std::move(material), addTexture(scene_, texture, repeats));
    }

    /// Returns a material, sometimes with a picture, bumps or varying roughness.
    Material richMaterial(float pictures) {
        Material material = anyMaterial(true);
        if (material.transmission > 0.0f) return material;
        if (chance(pictures)) material = pictured(std::move(material));
        if (chance(0.25f)) {
            const float repeats = logarithmic(0.7f, 6.0f);
            material.normalTexture =
                addTexture(scene_, chance(0.5f) ? hammeredNormalTexture() : brickNormalTexture(), repeats);
            material.normalScale = random_.next(0.3f, 1.5f);
        }
        if (material.specular > 0.0f && chance(0.25f)) {
            const float smooth = random_.next(0.1f, 0.4f);
            const float rough = random_.next(0.5f, 0.9f);
            material.metallicRoughnessTexture =
                addTexture(scene_, wornRoughnessTexture(smooth, rough), logarithmic(0.5f, 3.0f));
            material.roughness = 1.0f;
        }
        return material;
    }

    /// Adds an object of a random kind, size and position.
    void addThing() {
        const float size = size_ * random_.next(0.4f, 1.0f);
        vec3 center = offset(reach_ - 0.5f * size);
        if (stands_) center.y = size + 0.001f + (chance(0.2f) ? random_.next(0.0f, reach_) : 0.0f);
        switch (whole(0, 8)) {
            case 0:
            case 1:
                return addBall(center, size);
            case 2:
                return addRing(center, size);
            case 3:
                return addBoard(center, size);
            case 4:
                return addGrille(center, size);
            case 5:
                return addRowOfBalls(center, size);
            case 6:
                return chance(0.5f) ? addSign(center, size) : addShadedLamp(center, size);
            default:
                return addBox(center, size);
        }
    }

    /// Rotates by a random angle about the vertical axis; objects that float, about any axis.
    mat4 placed(const vec3& center) {
        mat4 transform = glm::translate(mat4(1.0f), center);
        transform = glm::rotate(transform, random_.next(0.0f, 2.0f * pi), vec3(0, 1, 0));
        if (stands_) return transform;
        const vec3 axis = glm::normalize(vec3(1.0f, 0.0f, random_.next(-1.0f, 1.0f)));
        return glm::rotate(transform, random_.next(-1.0f, 1.0f), axis);
    }

    void addPlaced(Mesh mesh, const vec3& center, Material material) {
        const mat4 transform = placed(center);
        const int number = addMaterial(std::move(material));
        scene_.instances[addMesh(scene_, std::move(mesh), number)].transform = transform;
    }

    void addPlacedFlat(MeshBuilder& builder, const vec3& center, float pictures) {
        Mesh mesh = builder.take();
        addWallpaperCoordinates(mesh);
        addPlaced(std::move(mesh), center, richMaterial(pictures));
    }

    void addPlacedSmooth(MeshBuilder& builder, const vec3& center, float pictures) {
        Mesh mesh = builder.take();
        addSlantedCoordinates(mesh);
        addPlaced(std::move(mesh), center, richMaterial(pictures));
    }

    void addFlat(MeshBuilder& builder, float pictures) {
        Mesh mesh = builder.take();
        addWallpaperCoordinates(mesh);
        Material material = richMaterial(pictures);
        if (material.transmission > 0.0f) material = lambertian("diffuse", color(0.1f, 0.8f));
        addMesh(scene_, std::move(mesh), addMaterial(std::move(material)));
    }

    void addBall(const vec3& center, float size) {
        MeshBuilder ball("ball", true);
        ball.sphere(vec3(0.0f), size, 48, 24);
        addPlacedSmooth(ball, center, 0.35f);
    }

    void addRing(const vec3& center, float size) {
        MeshBuilder ring("ring", true);
        const float tube = random_.next(0.05f, 0.35f) * size;
        ring.torus(vec3(0.0f), size - tube, tube, 48, 20);
        addPlacedSmooth(ring, center, 0.3f);
    }

    void addBox(const vec3& center, float size) {
        MeshBuilder box("box");
        const vec3 half{size * random_.next(0.2f, 0.8f), size * random_.next(0.3f, 1.0f),
                        size * random_.next(0.2f, 0.8f)};
        box.box(-half, half);
        addPlacedFlat(box, center, 0.4f);
    }

    /// Adds a painting or a poster.
    void addBoard(const vec3& center, float size) {
        MeshBuilder board("board");
        const vec3 half{size * random_.next(0.5f, 1.2f), size, 0.02f * size};
        board.box(-half, half);
        addPlacedFlat(board, center, 0.9f);
    }

    /// Adds bars that may be thinner than a pixel.
    void addGrille(const vec3& center, float size) {
        MeshBuilder grille("grille");
        const int bars = whole(4, 30);
        const float pitch = 2.0f * size / static_cast<float>(bars), half = pitch * random_.next(0.1f, 0.35f);
        for (int i = 0; i < bars; ++i) {
            const float x = -size + (static_cast<float>(i) + 0.5f) * pitch;
            grille.box({x - half, -size, -half}, {x + half, size, half});
        }
        addPlacedFlat(grille, center, 0.2f);
    }

    /// Adds a row of balls with different materials, like material samples.
    void addRowOfBalls(const vec3& center, float size) {
        const int count = whole(3, 8);
        const float radius = size / static_cast<float>(count);
        MeshBuilder row("row", true);
        for (int i = 0; i < count; ++i)
            row.sphere({-size + (2.0f * static_cast<float>(i) + 1.0f) * radius, 0.0f, 0.0f}, 0.9f * radius,
                       24, 12, static_cast<uint16_t>(i));
        const mat4 transform = placed(center);
        const auto first = static_cast<int>(scene_.materials.size());
        const Material like = anyMaterial(true);
        for (int i = 0; i < count; ++i) {
            Material material = like;
            if (like.transmission == 0.0f) material.baseColor = vec4(color(0.05f, 0.9f), 1.0f);
            material.roughness = random_.next(0.0f, 1.0f);
            addMaterial(std::move(material));
        }
        scene_.instances[addMesh(scene_, row.take(), first)].transform = transform;
    }

    /// Adds a glowing tube.
    void addSign(const vec3& center, float size) {
        MeshBuilder tube("sign", true);
        const float radius = random_.next(0.01f, 0.08f) * size;
        tube.torus(vec3(0.0f), size - radius, radius, 48, 10);
        const vec3 radiance = strongly(0.5f, 30.0f, color(0.02f, 1.0f));
        addPlaced(tube.take(), center, emitter("sign", vec3(0.3f), radiance));
    }

    /// Adds a bulb in an opaque or translucent shade; sometimes a point light replaces most of the bulb's
    /// power.
    void addShadedLamp(const vec3& center, float size) {
        constexpr int sides = 20;
        const float bottom = size * random_.next(0.4f, 0.9f), top = size * random_.next(0.3f, 0.8f);
        const auto corner = [&](int i, float radius, float y) {
            const float angle = 2.0f * pi * static_cast<float>(i) / static_cast<float>(sides);
            return center + vec3(radius * std::cos(angle), y, -radius * std::sin(angle));
        };
        MeshBuilder shade("shade");
        for (int i = 0; i < sides; ++i)
            shade.quad(corner(i, bottom, -size), corner(i + 1, bottom, -size), corner(i + 1, top, size),
                       corner(i, top, size));
        Material cloth = lambertian("shade", color(0.3f, 0.9f));
        cloth.doubleSided = true;
        if (chance(0.6f)) {
            cloth.specular = 1.0f;
            cloth.roughness = random_.next(0.3f, 1.0f);
            cloth.transmission = random_.next(0.2f, 0.9f);
        }
        addMesh(scene_, shade.take(), addMaterial(std::move(cloth)));
        const float radius = random_.next(0.05f, 0.2f) * size;
        const vec3 power = reach_ * reach_ * strongly(0.05f, 1.0f, lightColor());
        MeshBuilder bulb("bulb", true);
        bulb.sphere(center, radius, 16, 10);
        const bool hasPoint = chance(0.5f);
        addMesh(
            scene_, bulb.take(),
            addMaterial(emitter("bulb", vec3(0.5f), power / (radius * radius) * (hasPoint ? 0.1f : 1.0f))));
        if (hasPoint) addPointLight(center + vec3(0.0f, 1.5f * radius, 0.0f), 3.0f * power);
    }

    void addPointLight(const vec3& position, const vec3& intensity) {
        PunctualLight light;
        light.kind = PunctualLight::Kind::Point;
        light.position = position;
        light.intensity = intensity;
        light.name = "point";
        scene_.lights.push_back(light);
    }

    void addSurroundings() {
        const float kind = random_.next(0.0f, 1.0f);
        if (kind < 0.12f) return;
        const float strength = logarithmic(0.05f, 3.0f);
        if (kind < 0.4f) {
            scene_.environment = softSky();
            const vec3 tint = strength * lightColor();
            for (vec3& radiance : scene_.environment.radiance) radiance *= tint;
            return;
        }
        addStudio(strength);
    }

    /// Makes an environment of cloudy walls in two colours, with windows and lamps.
    void addStudio(float strength) {
        Environment& picture = scene_.environment;
        picture = {128, 64, {}};
        const vec3 above = strength * lightColor(), below = strength * color(0.02f, 0.8f);
        const float dark = random_.next(0.0f, 0.8f);
        const Texture clouds = noiseTexture(static_cast<uint32_t>(whole(2, 9)), vec3(dark), vec3(1.0f));
        for (uint32_t y = 0; y < picture.height; ++y) {
            for (uint32_t x = 0; x < picture.width; ++x) {
                const float up = 1.0f - (static_cast<float>(y) + 0.5f) / static_cast<float>(picture.height);
                const size_t texel = size_t{4} * (y * clouds.height / picture.height * clouds.width +
                                                  x * clouds.width / picture.width);
                const float shade = static_cast<float>(clouds.rgba[texel]) / 255.0f;
                picture.radiance.push_back(shade * shade *
                                           glm::mix(below, above, glm::smoothstep(0.3f, 0.7f, up)));
            }
        }
        const int lamps = whole(0, 6);
        for (int i = 0; i < lamps; ++i) addStudioLamp(picture);
    }

    void addStudioLamp(Environment& picture) {
        const vec3 radiance = strongly(2.0f, 100.0f, lightColor());
        const uvec2 first{static_cast<uint32_t>(whole(0, 127)), static_cast<uint32_t>(whole(2, 40))};
        const uvec2 extent{static_cast<uint32_t>(whole(1, 14)), static_cast<uint32_t>(whole(1, 10))};
        for (uint32_t y = first.y; y < first.y + extent.y; ++y) {
            for (uint32_t x = first.x; x < first.x + extent.x; ++x)
                picture.radiance[y * picture.width + x % picture.width] = radiance;
        }
    }

    void addLights() {
        if (chance(0.25f) || (scene_.environment.empty() && chance(0.5f))) {
            PunctualLight sun;
            sun.kind = PunctualLight::Kind::Directional;
            const vec3 travels{random_.next(-1.0f, 1.0f), random_.next(-2.0f, -0.3f),
                               random_.next(-1.0f, 1.0f)};
            sun.direction = glm::normalize(travels);
            sun.intensity = strongly(0.5f, 12.0f, lightColor());
            sun.name = "sun";
            scene_.lights.push_back(sun);
        }
        const bool isDark = scene_.environment.empty() && scene_.lights.empty();
        const int points = isDark ? whole(1, 4) : chance(0.25f) ? whole(1, 3) : 0;
        for (int i = 0; i < points; ++i) {
            vec3 position = offset(1.5f * reach_);
            if (stands_) position.y = std::abs(position.y) + 0.1f;
            addPointLight(position, reach_ * reach_ * strongly(0.1f, 3.0f, lightColor()));
        }
    }

    void placeCamera() {
        const float fov = random_.next(0.4f, 1.2f);
        const float fills = logarithmic(0.4f, 2.0f);  // fraction of the picture's height
        const float distance = std::max(1.4f * reach_ / (std::tan(0.5f * fov) * fills), 2.2f * reach_);
        const float around = random_.next(0.0f, 2.0f * pi),
                    above = random_.next(stands_ ? 0.03f : -0.9f, 0.9f);
        const vec3 away(std::cos(above) * std::sin(around), std::sin(above),
                        std::cos(above) * std::cos(around));
        const vec3 target = offset(0.4f * reach_) + vec3(0.0f, stands_ ? 0.4f * reach_ : 0.0f, 0.0f);
        vec3 eye = target + distance * away;
        if (stands_) eye.y = std::max(eye.y, 0.15f * reach_);
        addCamera(scene_, eye, target, fov);
    }

    float reach_ = 1.0f, size_ = 0.5f;
    bool stands_ = false;  ///< whether there is a surface at height 0
};

}  // namespace

Scene randomStillLife(uint32_t seed) {
    return RandomStillLife(seed).make();
}

}  // namespace limpid::scene
