#include "scene/prepare/opaque.h"

#include <algorithm>
#include <optional>
#include <vector>

namespace limpid::scene {
namespace {

/// The lowest alpha of a texture. Filters give no less.
float lowestAlpha(const Texture& texture) {
    uint8_t lowest = 255;
    for (size_t i = 3; i < texture.rgba.size() && lowest > 0; i += 4)
        lowest = std::min(lowest, texture.rgba[i]);
    return static_cast<float>(lowest) / 255.0f;
}

/// The lowest alpha of the vertices of each material slot; empty if the mesh has no colours.
std::vector<float> slotAlphas(const Mesh& mesh) {
    std::vector<float> alphas;
    for (size_t i = 0; !mesh.colors.empty() && i < mesh.indices.size(); ++i) {
        const size_t slot = mesh.materialSlots.empty() ? 0 : mesh.materialSlots[i / 3];
        if (slot >= alphas.size()) alphas.resize(slot + 1, 1.0f);
        alphas[slot] = std::min(alphas[slot], mesh.colors[mesh.indices[i]].a);
    }
    return alphas;
}

/// The lowest alpha of the vertices where each material is used.
std::vector<float> vertexAlphas(const Scene& scene) {
    std::vector<std::vector<float>> ofMeshes;
    for (const Mesh& mesh : scene.meshes) ofMeshes.push_back(slotAlphas(mesh));
    std::vector<float> alphas(scene.materials.size(), 1.0f);
    for (const Instance& instance : scene.instances) {
        auto material = alphas.begin() + instance.material;
        for (const float alpha : ofMeshes[static_cast<size_t>(instance.mesh)]) {
            *material = std::min(*material, alpha);
            ++material;
        }
    }
    return alphas;
}

}  // namespace

void makeOpaque(Scene& scene) {
    const auto isOpaque = [](const Material& material) { return material.alphaMode == AlphaMode::Opaque; };
    if (std::ranges::all_of(scene.materials, isOpaque)) return;
    const std::vector<float> ofVertices = vertexAlphas(scene);
    std::vector<std::optional<float>> ofTextures(scene.textures.size());
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        Material& material = scene.materials[i];
        const float needed = material.alphaMode == AlphaMode::Mask ? material.alphaCutoff : 1.0f;
        float alpha = material.baseColor.a * ofVertices[i];
        if (isOpaque(material) || alpha < needed) continue;
        if (material.baseColorTexture) {
            const auto texture = static_cast<size_t>(material.baseColorTexture.texture);
            if (!ofTextures[texture]) ofTextures[texture] = lowestAlpha(scene.textures[texture]);
            alpha *= *ofTextures[texture];
        }
        if (alpha >= needed) material.alphaMode = AlphaMode::Opaque;
    }
}

}  // namespace limpid::scene
