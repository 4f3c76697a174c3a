#include "scene/motion/movement.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/log.h"
#include "scene/framing/framing.h"

namespace limpid::scene {
namespace {

/// Returns the clip that combines all clips, creating it once.
int clipOfAll(Rig& rig) {
    if (rig.clips.size() == 1) return 0;
    ClipsTogether all = playTogether(rig);
    if (all.overridden > 0) {
        log::warn(
            "{} values of nodes are animated by several clips; of these the last clip's count, for all play "
            "together",
            all.overridden);
    }
    rig.clips.push_back(std::move(all.clip));
    return static_cast<int>(rig.clips.size()) - 1;
}

int findClip(Rig& rig, std::string_view choice) {
    if (choice.empty() && !rig.clips.empty()) return 0;
    std::string known;
    for (size_t i = 0; i < rig.clips.size(); ++i) {
        if (rig.clips[i].name == choice || std::to_string(i) == choice) return static_cast<int>(i);
        known += fmt::format(" {} '{}'", i, rig.clips[i].name);
    }
    if (known.empty()) throw UsageError("the scene has no animations");
    if (choice == "all") return clipOfAll(rig);
    throw UsageError(fmt::format("the scene has no animation '{}'; its animations are{}, and 'all' together",
                                 choice, known));
}

bool animatesWeights(const Clip& clip, int node) {
    return std::any_of(clip.channels.begin(), clip.channels.end(), [&](const Channel& channel) {
        return channel.node == node && channel.value == AnimatedValue::Weights;
    });
}

}  // namespace

std::string clipChoice(const Scene& scene) {
    if (scene.clip == none) return {};
    return scene.rig.clips[static_cast<size_t>(scene.clip)].together ? "all" : std::to_string(scene.clip);
}

void chooseClip(Scene& scene, std::string_view choice) {
    scene.clip = findClip(scene.rig, choice);
    const Clip& clip = scene.rig.clips[static_cast<size_t>(scene.clip)];
    const std::vector<bool> moved = movedNodes(scene.rig, clip);
    const auto isMoved = [&](int node) { return node != none && moved[static_cast<size_t>(node)]; };
    for (Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        bool deforming = false, rigid = isMoved(instance.node);
        if (mesh.deformation) {
            deforming = !mesh.deformation->targets.empty() && animatesWeights(clip, instance.node);
            if (instance.skin != none) {
                const Skin& skin = scene.rig.skins[static_cast<size_t>(instance.skin)];
                rigid = false;  // the node's own transform is ignored
                deforming |= std::any_of(skin.joints.begin(), skin.joints.end(), isMoved);
            }
        }
        instance.movement = deforming ? Movement::Deforming : rigid ? Movement::Rigid : Movement::Still;
    }
    for (Camera& camera : scene.cameras) {
        if (camera.name == framingCameraName && camera.node == none) camera = frameScene(scene);
    }
}

}  // namespace limpid::scene
