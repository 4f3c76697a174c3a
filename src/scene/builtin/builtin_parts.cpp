#include "scene/builtin/builtin_parts.h"

#include <cmath>

#include "scene/model/camera.h"

namespace limpid::scene {

Material lambertian(std::string name, const vec3& albedo) {
    Material m;
    m.name = std::move(name);
    m.baseColor = vec4(albedo, 1.0f);
    m.metallic = 0.0f;
    m.specular = 0.0f;
    return m;
}

Material emitter(std::string name, const vec3& albedo, const vec3& radiance) {
    Material m = lambertian(std::move(name), albedo);
    m.emission = radiance;
    return m;
}

Material glossy(std::string name, const vec3& color, float metallic, float roughness) {
    Material m;
    m.name = std::move(name);
    m.baseColor = vec4(color, 1.0f);
    m.metallic = metallic;
    m.roughness = roughness;
    return m;
}

Material textured(Material material, const TextureRef& baseColor) {
    material.baseColorTexture = baseColor;
    return material;
}

void addBlock(MeshBuilder& builder, const vec2& center, const vec2& halfSize, float height, float angle,
              uint16_t slot) {
    const vec2 x = halfSize.x * vec2(std::cos(angle), -std::sin(angle));
    const vec2 z = halfSize.y * vec2(std::sin(angle), std::cos(angle));
    const auto corner = [&](float alongX, float alongZ) {
        const vec2 p = center + alongX * x + alongZ * z;
        return vec3(p.x, 0.0f, p.y);
    };
    builder.prism(corner(-1, 1), corner(1, 1), corner(1, -1), corner(-1, -1), height, slot);
}

void addLamp(MeshBuilder& builder, const vec3& center, float halfWidth, float halfDepth, uint16_t slot) {
    const vec3 x(halfWidth, 0.0f, 0.0f), z(0.0f, 0.0f, halfDepth);
    builder.quad(center - x - z, center + x - z, center + x + z, center - x + z, slot);
}

TextureRef addTexture(Scene& scene, Texture texture, float repeats) {
    scene.textures.push_back(std::move(texture));
    TextureRef ref;
    ref.texture = static_cast<int>(scene.textures.size() - 1);
    ref.rowU.x = ref.rowV.y = repeats;
    return ref;
}

void addCamera(Scene& scene, const vec3& eye, const vec3& target, float verticalFov) {
    scene.cameras.push_back(lookAt(eye, target, vec3(0, 1, 0), verticalFov));
    scene.cameras.back().name = scene.name;
}

size_t addMesh(Scene& scene, Mesh mesh, int material) {
    Instance instance;
    instance.name = mesh.name;
    instance.mesh = static_cast<int>(scene.meshes.size());
    instance.material = material;
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back(std::move(instance));
    return scene.instances.size() - 1;
}

int addNode(Scene& scene, size_t instance) {
    const auto node = static_cast<int>(scene.rig.nodes.size());
    scene.rig.nodes.emplace_back().name = scene.instances[instance].name;
    scene.rig.order.push_back(node);
    scene.instances[instance].node = node;
    return node;
}

void addClip(Scene& scene, Clip clip) {
    const RigPose start = evaluate(scene.rig, &clip, 0.0);
    for (Instance& instance : scene.instances) {
        if (instance.node != none) instance.transform = start.toWorld[static_cast<size_t>(instance.node)];
    }
    scene.rig.clips.push_back(std::move(clip));
}

}  // namespace limpid::scene
