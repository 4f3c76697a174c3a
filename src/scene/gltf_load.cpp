#include "scene/gltf_load.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "base/error.h"
#include "scene/gltf_access.h"
#include "scene/gltf_camera.h"
#include "scene/gltf_document.h"
#include "scene/gltf_material.h"
#include "scene/gltf_mesh.h"
#include "scene/gltf_nodes.h"
#include "scene/mesh_repair.h"

namespace limpid::scene::gltf {
namespace {

/// One document's way into a Scene.
class Loader {
  public:
    explicit Loader(const std::filesystem::path& file) : document_(file), lists_(document_.lists()) {}

    Scene run() {
        scene_.name = document_.file().stem().string();
        readMaterials();
        tree_ = readNodes(document_);
        for (size_t i = 0; i < lists_.nodes.size(); ++i) {
            if (tree_.inScene[i]) addNode(i);
        }
        if (scene_.materials.empty()) scene_.materials.emplace_back();
        return std::move(scene_);
    }

  private:
    void readMaterials();
    int defaultMaterial();
    void addNode(size_t node);
    void addMesh(size_t node, const Object& mesh);
    Pose readPose(const Object& node, const Object& mesh);
    const std::vector<mat4>& jointMatrices(int skin);
    void addInstance(const Object& node, int mesh, int material, const mat4& transform);

    Document document_;
    const Document::Lists& lists_;
    Scene scene_;
    MeshLibrary meshes_{document_, scene_};
    TextureLibrary textures_{document_, scene_};
    NodeTree tree_;
    std::map<int, std::vector<mat4>> joints_;  ///< by skin
    int defaultMaterial_ = none;
};

void Loader::readMaterials() {
    for (const Object& source : lists_.materials) {
        scene_.materials.push_back(readMaterial(document_, source, textures_));
    }
    textures_.checkUnused();
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
    if (const int mesh = node.index("mesh", lists_.meshes.size()); mesh != none) {
        addMesh(i, lists_.meshes[static_cast<size_t>(mesh)]);
    }
    if (const int camera = node.index("camera", lists_.cameras.size()); camera != none) {
        const Object& source = lists_.cameras[static_cast<size_t>(camera)];
        scene_.cameras.push_back(readCamera(source, tree_.toWorld[i], node.text("name")));
    }
    const auto light = node.extension("KHR_lights_punctual");
    if (!light) return;
    const int index = light->index("light", lists_.lights.size());
    if (index == none) light->fail("has no light");
    const Object& source = lists_.lights[static_cast<size_t>(index)];
    scene_.lights.push_back(readLight(document_, source, tree_.toWorld[i], node.text("name")));
}

void Loader::addMesh(size_t i, const Object& mesh) {
    const Object& node = lists_.nodes[i];
    const Pose pose = readPose(node, mesh);
    const std::vector<Object> primitives = mesh.objects("primitives");
    const std::string meshName = mesh.text("name", mesh.place());
    for (size_t p = 0; p < primitives.size(); ++p) {
        const std::string name = primitives.size() == 1 ? meshName : fmt::format("{}.{}", meshName, p);
        const int index = meshes_.add(primitives[p], name, pose);
        if (index == none) continue;
        int material = primitives[p].index("material", lists_.materials.size());
        if (material == none) material = defaultMaterial();
        // Skinned vertices are in world space already: the node's own transform does not count
        // (glTF 3.7.3.3).
        addInstance(node, index, material, pose.joints ? mat4(1.0f) : tree_.toWorld[i]);
    }
}

Pose Loader::readPose(const Object& node, const Object& mesh) {
    Pose pose;
    pose.weights = node.has("weights") ? node.numbers("weights") : mesh.numbers("weights");
    pose.skin = node.index("skin", lists_.skins.size());
    if (pose.skin != none) pose.joints = &jointMatrices(pose.skin);
    return pose;
}

const std::vector<mat4>& Loader::jointMatrices(int skin) {
    const auto [entry, isNew] = joints_.try_emplace(skin);
    if (!isNew) return entry->second;
    const Object& source = lists_.skins[static_cast<size_t>(skin)];
    const std::vector<int> nodes = source.indices("joints", lists_.nodes.size());
    const int accessor = source.index("inverseBindMatrices", lists_.accessors.size());
    std::vector<mat4> inverseBind(nodes.size(), mat4(1.0f));
    if (accessor != none) inverseBind = readMat4(document_, accessor);
    if (inverseBind.size() < nodes.size())
        source.fail("inverseBindMatrices", "has fewer matrices than there are joints");
    for (size_t j = 0; j < nodes.size(); ++j) {
        entry->second.push_back(tree_.toWorld[static_cast<size_t>(nodes[j])] * inverseBind[j]);
    }
    return entry->second;
}

/// Whether the transform flattens what it moves, so that it has no inverse.
bool isSingular(const mat4& transform) {
    const mat3 m(transform);
    const float lengths = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
    return !(std::abs(glm::determinant(m)) > 1e-12f * lengths);
}

void Loader::addInstance(const Object& node, int mesh, int material, const mat4& transform) {
    if (scene_.instances.size() >= maxInstances)
        node.fail(fmt::format("is instance {} of the scene, too many", maxInstances));
    Instance instance{mesh, material, transform, node.text("name", node.place())};
    if (isSingular(transform)) {
        // A scale of zero in all directions is a way of hiding things.
        if (vec3(transform[0]) == vec3(0.0f) && vec3(transform[1]) == vec3(0.0f) &&
            vec3(transform[2]) == vec3(0.0f))
            return;
        document_.warn(node.place() + " is flattened by its transform and loses its normals");
        instance.mesh = meshes_.flatten(node, mesh, transform);
        instance.transform = mat4(1.0f);
    }
    scene_.instances.push_back(std::move(instance));
}

}  // namespace

Scene load(const std::filesystem::path& file) {
    Scene scene = Loader(file).run();
    if (scene.triangleCount() == 0) throw InputError(file, "has no triangles to draw");
    return scene;
}

}  // namespace limpid::scene::gltf
