#include "scene/prepare/prepare.h"

#include <algorithm>
#include <set>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "scene/framing/framing.h"
#include "scene/framing/light_reach.h"
#include "scene/lights/environment.h"
#include "scene/load/validate.h"
#include "scene/prepare/opaque.h"
#include "scene/prepare/tangents.h"

namespace limpid::scene {
namespace {

/// Returns the material slots that each mesh uses.
std::vector<std::vector<uint16_t>> slotsOfMeshes(const Scene& scene) {
    std::vector<std::vector<uint16_t>> slots;
    for (const Mesh& mesh : scene.meshes) {
        const std::set<uint16_t> distinct(mesh.materialSlots.begin(), mesh.materialSlots.end());
        slots.emplace_back(distinct.begin(), distinct.end());
        if (slots.back().empty()) slots.back().push_back(0);
    }
    return slots;
}

/// Calls use(mesh index, material) for each material of each instance.
template <typename Use>
void forEachMaterialUse(const Scene& scene, const Use& use) {
    const auto slots = slotsOfMeshes(scene);
    for (const Instance& instance : scene.instances) {
        const auto mesh = static_cast<size_t>(instance.mesh);
        for (const uint16_t slot : slots[mesh]) {
            use(mesh, scene.materials[static_cast<size_t>(instance.material) + slot]);
        }
    }
}

void addTangents(Scene& scene) {
    std::vector<int> uvSet(scene.meshes.size(), none);
    forEachMaterialUse(scene, [&](size_t mesh, const Material& material) {
        // Anisotropy has a direction, with or without a texture.
        if (material.anisotropy > 0.0f && uvSet[mesh] == none) uvSet[mesh] = 0;
        for (const TextureRef& ref :
             {material.anisotropyTexture, material.clearcoatNormalTexture, material.normalTexture}) {
            if (ref) uvSet[mesh] = ref.uvSet;
        }
    });
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        if (uvSet[i] != none && scene.meshes[i].tangents.empty()) generateTangents(scene.meshes[i], uvSet[i]);
    }
}

bool hasLight(const Scene& scene) {
    if (!scene.environment.empty() || !scene.lights.empty()) return true;
    bool found = false;
    forEachMaterialUse(
        scene, [&](size_t, const Material& material) { found = found || material.emission != vec3(0.0f); });
    return found;
}

void addSky(Scene& scene, SkyRule rule) {
    if (rule == SkyRule::Never || !scene.environment.empty()) return;
    if (!hasLight(scene)) {
        scene.environment = softSky();
        log::warn("nothing in the scene emits light: a soft sky was added");
        return;
    }
    if (rule != SkyRule::InTheDark) return;
    const double dark = estimateLightReach(scene, scene.cameras.front()).darkShare();
    if (dark < darkShareForSky) return;
    scene.environment = softSky();
    log::warn(
        "the scene's lights leave about {:.0f} % of what is seen black: a soft sky was added (--background "
        "0,0,0: "
        "none)",
        100.0 * dark);
}

}  // namespace

void prepare(Scene& scene, SkyRule rule) {
    if (const auto fault = findFault(scene)) throw Error("the scene '" + scene.name + "': " + *fault);
    makeOpaque(scene);
    addTangents(scene);
    if (scene.cameras.empty()) {
        scene.cameras.push_back(frameScene(scene));
        log::info("the scene has no camera: one that shows all of it was added");
    }
    addSky(scene, rule);
}

}  // namespace limpid::scene
