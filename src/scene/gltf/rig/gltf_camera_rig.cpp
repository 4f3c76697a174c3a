#include "scene/gltf/rig/gltf_camera_rig.h"

#include <algorithm>
#include <limits>

#include "scene/gltf/rig/gltf_animation.h"
#include "scene/gltf/rig/gltf_camera.h"
#include "scene/gltf/rig/gltf_nodes.h"
#include "scene/load/load_options.h"
#include "scene/model/camera.h"

namespace limpid::scene::gltf {

CameraRig loadCameras(const std::filesystem::path& file) {
    Document document(file, defaultAssetRoot(file));
    const NodeTree tree = readNodes(document);
    CameraRig result;
    const Document::Lists& lists = document.lists();
    for (size_t i = 0; i < lists.nodes.size(); ++i) {
        const int camera = tree.inScene[i] ? lists.nodes[i].index("camera", lists.cameras.size()) : none;
        if (camera == none) continue;
        const Object& source = lists.cameras[static_cast<size_t>(camera)];
        result.cameras.push_back(readCamera(source, tree.toWorld[i], tree.nodes[i].name));
        result.cameras.back().node = static_cast<int>(i);
    }
    result.rig.nodes = tree.nodes;
    result.rig.order = tree.order;
    if (!result.cameras.empty()) result.rig.clips = readAnimations(document, tree.nodes);
    return result;
}

CameraMovement::CameraMovement(const CameraRig& all, const Camera& camera) : camera_(camera) {
    std::vector<int> path;  // from the camera to its root
    for (int node = camera.node; node != none; node = all.rig.nodes[static_cast<size_t>(node)].parent)
        path.push_back(node);
    std::reverse(path.begin(), path.end());
    for (size_t i = 0; i < path.size(); ++i) {
        chain_.nodes.push_back(all.rig.nodes[static_cast<size_t>(path[i])]);
        chain_.nodes.back().parent = static_cast<int>(i) - 1;
        chain_.order.push_back(static_cast<int>(i));
    }
    for (Channel& channel : playTogether(all.rig).clip.channels) {
        const auto found = std::find(path.begin(), path.end(), channel.node);
        if (found == path.end() || channel.value == AnimatedValue::Weights) continue;
        channel.node = static_cast<int>(found - path.begin());
        clip_.channels.push_back(std::move(channel));
    }
}

Camera CameraMovement::at(double time) const {
    Camera camera = camera_;
    camera.toWorld = withoutScale(evaluate(chain_, &clip_, time).toWorld.back());
    return camera;
}

float CameraMovement::firstKey() const {
    float first = std::numeric_limits<float>::max();
    for (const Channel& channel : clip_.channels) first = std::min(first, channel.times.front());
    return first;
}

}  // namespace limpid::scene::gltf
