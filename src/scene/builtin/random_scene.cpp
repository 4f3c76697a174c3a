#include "scene/builtin/random_scene.h"

#include <algorithm>
#include <cmath>

#include "scene/builtin/procedural_textures.h"

namespace limpid::scene {

RandomScene::RandomScene(std::string_view kind, uint32_t seed) : random_(seed) {
    scene_.name = std::string(kind) + "-" + std::to_string(seed);
}

int RandomScene::whole(int least, int most) {
    return std::min(static_cast<int>(random_.next(static_cast<float>(least), static_cast<float>(most + 1))),
                    most);
}

float RandomScene::logarithmic(float least, float most) {
    return std::exp(random_.next(std::log(least), std::log(most)));
}

vec3 RandomScene::color(float least, float most) {
    const vec3 hue{random_.next(least, most), random_.next(least, most), random_.next(least, most)};
    const vec3 grey((hue.x + hue.y + hue.z) / 3.0f);
    return glm::mix(grey, hue, random_.next(0.0f, 1.0f));
}

vec3 RandomScene::lightColor() {
    if (chance(0.15f)) return color(0.05f, 1.0f);
    return glm::mix(vec3(1.0f, 0.62f, 0.3f), vec3(0.75f, 0.88f, 1.0f), random_.next(0.0f, 1.0f));
}

vec3 RandomScene::offset(float reach) {
    return vec3{random_.next(-reach, reach), random_.next(-reach, reach), random_.next(-reach, reach)};
}

int RandomScene::addMaterial(Material material) {
    scene_.materials.push_back(std::move(material));
    return static_cast<int>(scene_.materials.size() - 1);
}

Texture RandomScene::pattern() {
    const vec3 dark = color(0.05f, 0.5f), bright = color(0.4f, 0.9f);
    switch (whole(0, 3)) {
        case 0:
            return checkerTexture(static_cast<uint32_t>(2 * whole(1, 6)), dark, bright);
        case 1:
            return noiseTexture(static_cast<uint32_t>(whole(2, 12)), dark, bright);
        case 2:
            return brickTexture();
        default:
            return woodTexture();
    }
}

Material RandomScene::roughened(Material material, float least) {
    material.roughness = random_.next(least, 0.7f);
    return material;
}

Material RandomScene::patterned(Material material, float least, float most) {
    material.baseColor = vec4(color(0.5f, 1.0f), 1.0f);
    const Texture texture = pattern();
    const float repeats = random_.next(least, most);
    return textured(std::move(material), addTexture(scene_, texture, repeats));
}

Material RandomScene::anyMaterial(bool mayBeGlass) {
    const float kind = random_.next(0.0f, 1.0f);
    if (kind < 0.45f) return lambertian("diffuse", color(0.05f, 0.85f));
    if (kind < 0.70f) return roughened(glossy("glossy", color(0.05f, 0.8f), 0.0f, 0.0f), 0.05f);
    if (kind < 0.85f) return roughened(glossy("metal", color(0.3f, 0.95f), 1.0f, 0.0f), 0.08f);
    if (kind < 0.90f) return glossy("mirror", color(0.8f, 0.97f), 1.0f, 0.0f);
    if (kind < 0.97f || !mayBeGlass) {
        Material lacquer = lambertian("lacquer", color(0.05f, 0.7f));
        lacquer.clearcoat = 1.0f;
        lacquer.clearcoatRoughness = random_.next(0.0f, 0.3f);
        return lacquer;
    }
    Material glass = glossy("glass", vec3(1.0f), 0.0f, chance(0.5f) ? 0.0f : random_.next(0.05f, 0.3f));
    glass.transmission = 1.0f;
    glass.thin = false;
    return glass;
}

}  // namespace limpid::scene
