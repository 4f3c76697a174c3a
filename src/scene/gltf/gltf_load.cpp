#include "scene/gltf/gltf_load.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "base/error.h"
#include "scene/gltf/document/gltf_document.h"
#include "scene/gltf/gltf_material.h"
#include "scene/gltf/gltf_mesh.h"
#include "scene/gltf/rig/gltf_animation.h"
#include "scene/gltf/rig/gltf_camera.h"
#include "scene/gltf/rig/gltf_nodes.h"
#include "scene/prepare/mesh_repair.h"

namespace limpid::scene::gltf {
namespace {

/// Converts one document to a Scene.
class Loader {
  public:
    Loader(const std::filesystem::path& file, const LoadOptions& options)
        : document_(file, options.assetRoot),
          lists_(document_.lists()),
          textures_(document_, scene_, options),
          progress_(options.progress) {}

    Scene run() {
        scene_.name = document_.file().stem().string();
        readMaterials();
        tree_ = readNodes(document_);
        readRig();
        for (size_t i = 0; i < lists_.nodes.size(); ++i) {
            progress_.part(0.7, 1.0).at(i, lists_.nodes.size());
            if (tree_.inScene[i]) addNode(i);
        }
        if (scene_.materials.empty()) scene_.materials.emplace_back();
        scene_.files = document_.files().used();
        return std::move(scene_);
    }

  private:
    struct Primitive {
        Object source;
        std::string name;
        bool isDrawn = true;
    };

    void readMaterials();
    void readRig();
    int defaultMaterial();
    void addNode(size_t node);
    void addMesh(size_t node, int mesh);
    std::vector<Primitive>& primitivesOf(int mesh);
    Pose readPose(size_t node, const Object& mesh);
    const std::vector<mat4>& jointMatrices(int skin);
    void addInstance(size_t node, int mesh, int material, const Pose& pose);
    bool isAnimated(size_t node) const;

    Document document_;
    const Document::Lists& lists_;
    Scene scene_;
    MeshLibrary meshes_{document_, scene_};
    TextureLibrary textures_;
    Progress progress_;
    NodeTree tree_;
    std::map<int, std::vector<mat4>> joints_;           ///< by skin
    std::vector<bool> animated_;                        ///< by node: whether a clip moves it
    std::map<int, std::vector<Primitive>> primitives_;  ///< by mesh, since many nodes may have the same one
    uint64_t weights_ = 0;                              ///< of morph targets, of all nodes
    int defaultMaterial_ = none;
};

void Loader::readMaterials() {
    for (const Object& source : lists_.materials) {
        progress_.part(0.0, 0.7).at(scene_.materials.size(), lists_.materials.size());
        scene_.materials.push_back(readMaterial(document_, source, textures_));
    }
    textures_.checkUnused();
}

void Loader::readRig() {
    scene_.rig.nodes = tree_.nodes;
    scene_.rig.order = tree_.order;
    scene_.rig.clips = readAnimations(document_, tree_.nodes);
    for (const Object& skin : lists_.skins) scene_.rig.skins.push_back(readSkin(document_, skin));
    for (const Clip& clip : scene_.rig.clips) {
        std::vector<bool> moved = movedNodes(scene_.rig, clip);
        animated_.resize(moved.size(), false);
        for (size_t i = 0; i < moved.size(); ++i) animated_[i] = animated_[i] || moved[i];
    }
}

bool Loader::isAnimated(size_t node) const {
    return node < animated_.size() && animated_[node];
}

int Loader::defaultMaterial() {
    if (defaultMaterial_ == none) {
        defaultMaterial_ = static_cast<int>(scene_.materials.size());
        scene_.materials.emplace_back().name = "default";
    }
    return defaultMaterial_;
}

void Loader::addNode(size_t i) {
    const Object& node = lists_.nodes[i];
    if (const int mesh = node.index("mesh", lists_.meshes.size()); mesh != none) addMesh(i, mesh);
    if (const int camera = node.index("camera", lists_.cameras.size()); camera != none) {
        const Object& source = lists_.cameras[static_cast<size_t>(camera)];
        scene_.cameras.push_back(readCamera(source, tree_.toWorld[i], node.text("name")));
        scene_.cameras.back().node = static_cast<int>(i);
    }
    const auto light = node.extension("KHR_lights_punctual");
    if (!light) return;
    const int index = light->index("light", lists_.lights.size());
    if (index == none) light->fail("has no light");
    const Object& source = lists_.lights[static_cast<size_t>(index)];
    scene_.lights.push_back(readLight(document_, source, tree_.toWorld[i], node.text("name")));
    scene_.lights.back().node = static_cast<int>(i);
}

std::vector<Loader::Primitive>& Loader::primitivesOf(int mesh) {
    const auto [entry, isNew] = primitives_.try_emplace(mesh);
    if (!isNew) return entry->second;
    const Object& source = lists_.meshes[static_cast<size_t>(mesh)];
    const std::string meshName = source.text("name", source.place());
    for (Object& primitive : source.objects("primitives")) {
        const size_t p = entry->second.size();
        entry->second.push_back({std::move(primitive), fmt::format("{}.{}", meshName, p)});
    }
    if (entry->second.size() == 1) entry->second[0].name = meshName;
    return entry->second;
}

void Loader::addMesh(size_t node, int mesh) {
    const Pose pose = readPose(node, lists_.meshes[static_cast<size_t>(mesh)]);
    std::vector<Primitive>& primitives = primitivesOf(mesh);
    for (Primitive& primitive : primitives) {
        const int index = meshes_.add(primitive.source, primitive.name, pose);
        primitive.isDrawn = index != none;
        if (!primitive.isDrawn) continue;
        int material = primitive.source.index("material", lists_.materials.size());
        if (material == none) material = defaultMaterial();
        addInstance(node, index, material, pose);
    }
    // Points, lines and what is empty are so in every pose.
    std::erase_if(primitives, [](const Primitive& primitive) { return !primitive.isDrawn; });
}

Pose Loader::readPose(size_t nodeIndex, const Object& mesh) {
    const Object& node = lists_.nodes[nodeIndex];
    Pose pose;
    pose.weights = node.has("weights") ? node.numbers("weights") : mesh.numbers("weights");
    constexpr uint64_t maxWeights = uint64_t{1} << 24;
    weights_ += pose.weights.size();
    if (weights_ > maxWeights) node.fail("with it the scene has too many morph weights");
    scene_.rig.nodes[nodeIndex].weights = pose.weights;
    pose.skin = node.index("skin", lists_.skins.size());
    if (pose.skin != none) pose.joints = &jointMatrices(pose.skin);
    return pose;
}

const std::vector<mat4>& Loader::jointMatrices(int skin) {
    const auto [entry, isNew] = joints_.try_emplace(skin);
    if (!isNew) return entry->second;
    entry->second =
        scene::jointMatrices(scene_.rig.skins[static_cast<size_t>(skin)], RigPose{tree_.toWorld, {}});
    return entry->second;
}

/// True if the transform flattens objects, so that it has no inverse.
bool isSingular(const mat4& transform) {
    const mat3 m(transform);
    const float lengths = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
    return !(std::abs(glm::determinant(m)) > 1e-12f * lengths);
}

void Loader::addInstance(size_t nodeIndex, int mesh, int material, const Pose& pose) {
    const Object& node = lists_.nodes[nodeIndex];
    if (scene_.instances.size() >= maxInstances)
        node.fail(fmt::format("is instance {} of the scene, too many", maxInstances));
    Instance instance{.mesh = mesh, .material = material, .name = node.text("name", node.place())};
    instance.node = static_cast<int>(nodeIndex);
    instance.skin = pose.skin;
    // Skinned vertices are already in world space, so the node's own transform is ignored (glTF 3.7.3.3).
    if (!pose.joints) instance.transform = tree_.toWorld[nodeIndex];
    if (isSingular(instance.transform) && !isAnimated(nodeIndex)) {
        const mat3 m(instance.transform);
        // A scale of zero in all directions is used to hide objects.
        if (m[0] == vec3(0.0f) && m[1] == vec3(0.0f) && m[2] == vec3(0.0f)) return;
        document_.warn(node.place() + " is flattened by its transform and loses its normals");
        instance.mesh = meshes_.flatten(node, mesh, instance.transform);
        instance.transform = mat4(1.0f);
    }
    scene_.instances.push_back(std::move(instance));
}

}  // namespace

Scene load(const std::filesystem::path& file, const LoadOptions& options) {
    Scene scene = Loader(file, options).run();
    if (scene.triangleCount() == 0) throw InputError(file, "has no triangles to draw");
    return scene;
}

}  // namespace limpid::scene::gltf
