#include "scene/motion/scene_animator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "scene/device/pack.h"
#include "scene/device/trees/top_tree.h"
#include "scene/load/validate.h"
#include "scene/model/camera.h"
#include "scene/model/transform.h"
#include "scene/prepare/mesh_repair.h"

namespace limpid::scene {

/// The pose of the moving parts of the scene at one time.
struct SceneAnimator::Moment {
    RigPose pose;
    std::vector<mat4> transforms;            ///< for the moving leaves
    std::map<int, std::vector<mat4>> skins;  ///< joint matrices of the skins in use
};

namespace {

template <typename T>
void addUpload(SceneFrame& frame, std::string_view buffer, uint64_t offset, std::span<const T> values) {
    if (values.empty()) return;
    const auto bytes = std::as_bytes(values);
    frame.uploads.push_back({buffer, offset, {bytes.begin(), bytes.end()}});
}

template <typename T>
void addUpload(SceneFrame& frame, std::string_view buffer, uint64_t offset, const std::vector<T>& values) {
    addUpload(frame, buffer, offset, std::span<const T>(values));
}

/// Uploads to one buffer. Those that follow one another there become one copy, since a moving lamp may have
/// thousands of triangles.
class UploadRuns {
  public:
    UploadRuns(SceneFrame& frame, std::string_view buffer) : frame_(frame), buffer_(buffer) {}

    template <typename T>
    void add(uint64_t offset, std::span<const T> values) {
        const auto bytes = std::as_bytes(values);
        if (!begun_ || end_ != offset) {
            begun_ = true;
            last_ = frame_.uploads.size();
            frame_.uploads.push_back({buffer_, offset, {}});
        }
        std::vector<std::byte>& run = frame_.uploads[last_].bytes;
        run.insert(run.end(), bytes.begin(), bytes.end());
        end_ = offset + bytes.size();
    }

  private:
    SceneFrame& frame_;
    std::string_view buffer_;
    bool begun_ = false;
    size_t last_ = 0;   ///< index of the current run's upload
    uint64_t end_ = 0;  ///< where the run ends
};

bool isFinite(const mat4& m) {
    return scene::isFinite(m[0]) && scene::isFinite(m[1]) && scene::isFinite(m[2]) && scene::isFinite(m[3]);
}

bool isMirrored(const mat4& m) {
    return glm::determinant(mat3(m)) < 0.0f;
}

/// The same limit as findFault() for scenes at rest. Boxes that became NaN are empty and fail.
bool isInRange(const Aabb& box) {
    const auto small = [](const vec3& v) {
        const vec3 size = glm::abs(v);
        return size.x < coordinateLimit && size.y < coordinateLimit && size.z < coordinateLimit;
    };
    return !box.empty() && small(box.lower) && small(box.upper);
}

[[noreturn]] void failOutOfRange(const Instance& instance) {
    throw Error(fmt::format("instance '{}' leaves the range of numbers", instance.name));
}

/// Returns `box` with its corners moved by up to weight times `delta`.
Aabb widened(Aabb box, const Aabb& delta, float weight) {
    const vec3 a = weight * delta.lower, b = weight * delta.upper;
    box.lower += glm::min(a, b);
    box.upper += glm::max(a, b);
    return box;
}

}  // namespace

SceneAnimator::SceneAnimator(const Scene& scene, const SceneData& data)
    : scene_(scene), motion_(data.motion), params_(data.params), hasVertexData_(data.features.vertexData) {
    if (scene.clip == none) throw Error("no clip is chosen");
    for (const MovingLeaf& leaf : motion_.leaves)
        records_.push_back(data.instances[size_t{leaf.instance} * layout::INSTANCE_TEXELS + 3]);
    for (const gpu::TriangleTree& tree : data.trees) firstTriangles_.push_back(tree.first);
    setLights(data);
    // Free data that is already on the device; it is the largest part.
    motion_.restVertices.clear();
    motion_.morphDeltas.clear();
}

void SceneAnimator::setLights(const SceneData& data) {
    firstPunctual_ = data.lights.size() - scene_.lights.size() * layout::LIGHT_TEXELS;
    punctual_.assign(data.lights.begin() + static_cast<std::ptrdiff_t>(firstPunctual_), data.lights.end());
    motion_.lights = data.motion.lights;
    lightRecords_.clear();
    for (const MovingLights& lights : motion_.lights) {
        const auto first = data.lights.begin() + std::ptrdiff_t{lights.firstLight} * layout::LIGHT_TEXELS;
        const auto texels = static_cast<std::ptrdiff_t>(lights.triangles.size() * layout::LIGHT_TEXELS);
        lightRecords_.emplace_back(first, first + texels);
    }
    motion_.lightTree = data.motion.lightTree;
}

SceneAnimator::Moment SceneAnimator::momentAt(double time) const {
    Moment moment;
    moment.pose = evaluate(scene_.rig, &scene_.rig.clips[static_cast<size_t>(scene_.clip)], time);
    for (size_t node = 0; node < moment.pose.toWorld.size(); ++node) {
        if (!isFinite(moment.pose.toWorld[node]))
            throw Error(
                fmt::format("node {} '{}' leaves the range of numbers", node, scene_.rig.nodes[node].name));
    }
    for (const MovingLeaf& leaf : motion_.leaves) {
        const Instance& instance = scene_.instances[leaf.instance];
        const bool skinned = instance.skin != none;
        moment.transforms.push_back(skinned ? mat4(1.0f)
                                            : moment.pose.toWorld[static_cast<size_t>(instance.node)]);
        if (skinned && !moment.skins.contains(instance.skin)) {
            const Skin& skin = scene_.rig.skins[static_cast<size_t>(instance.skin)];
            moment.skins[instance.skin] = jointMatrices(skin, moment.pose);
        }
    }
    for (const auto& [skin, joints] : moment.skins) {
        for (const mat4& joint : joints) {
            if (!isFinite(joint)) throw Error(fmt::format("skin {} leaves the range of numbers", skin));
        }
    }
    return moment;
}

SceneFrame SceneAnimator::frame(double time, double previousTime) const {
    const Moment now = momentAt(time), before = momentAt(previousTime);
    SceneFrame frame;
    frame.params = params_;
    frame.refitLevels = motion_.refitLevels;
    frame.firstRefitNode = motion_.firstRefitNode;
    addPoses(now, before, frame);
    addInstances(now, before, frame);
    addMovingTree(now, frame);
    LightTree tree = motion_.lightTree;
    addTriangleLights(now, frame, tree);
    addPunctualLights(now, frame, tree);
    addLightTree(tree, frame);
    return frame;
}

void SceneAnimator::addPoses(const Moment& now, const Moment& before, SceneFrame& frame) const {
    std::vector<vec4> texels;
    const auto matrices = [&](const Moment& moment, int skin) {
        if (skin == none) return layout::NONE;
        const auto first = static_cast<uint32_t>(texels.size());
        for (const mat4& m : moment.skins.at(skin)) {
            for (int row = 0; row < 3; ++row) texels.emplace_back(m[0][row], m[1][row], m[2][row], m[3][row]);
        }
        return first;
    };
    const auto weights = [&](const Moment& moment, int node, uint32_t count) {
        if (count == 0) return layout::NONE;
        const auto first = static_cast<uint32_t>(texels.size());
        const std::vector<float>& values = moment.pose.weights[static_cast<size_t>(node)];
        texels.resize(texels.size() + (count + 3) / 4, vec4(0.0f));
        for (uint32_t i = 0; i < count && i < values.size(); ++i)
            texels[first + i / 4][static_cast<int>(i % 4)] = values[i];
        return first;
    };
    for (const DeformingInstance& d : motion_.deforming) {
        const Instance& instance = scene_.instances[d.instance];
        layout::PoseParams pose{};
        pose.firstVertex = d.firstVertex;
        pose.vertexCount = d.vertexCount;
        pose.morphFirst = d.morphFirstTexel;
        pose.targetCount = d.targetCount;
        pose.matricesNow = matrices(now, instance.skin);
        pose.matricesBefore = matrices(before, instance.skin);
        pose.weightsNow = weights(now, instance.node, d.targetCount);
        pose.weightsBefore = weights(before, instance.node, d.targetCount);
        pose.previousBase = params_.previousVertexBase;
        pose.hasVertexData = hasVertexData_ ? 1u : 0u;
        frame.poses.push_back(pose);
    }
    addUpload(frame, "poseMatrices", 0, texels);
}

void SceneAnimator::addInstances(const Moment& now, const Moment& before, SceneFrame& frame) const {
    UploadRuns instances(frame, "instances"), geometry(frame, "previousGeometry"),
        bvhInstances(frame, "bvhInstances");
    for (size_t i = 0; i < motion_.leaves.size(); ++i) {
        const MovingLeaf& leaf = motion_.leaves[i];
        const mat4& transform = now.transforms[i];
        std::array<uvec4, layout::INSTANCE_TEXELS> record{};
        packRows(record.data(), transform);
        record[3] = records_[i];
        record[3].w = (record[3].w & ~layout::INSTANCE_MIRRORED) |
                      (isMirrored(transform) ? layout::INSTANCE_MIRRORED : 0u);
        instances.add<uvec4>(uint64_t{leaf.instance} * sizeof(record), record);

        std::array<uvec4, layout::PREVIOUS_INSTANCE_TEXELS> previous{};
        packRows(previous.data(), before.transforms[i]);
        geometry.add<uvec4>(uint64_t{leaf.instance} * sizeof(previous), previous);

        std::array<uvec4, layout::BVH_INSTANCE_TEXELS> bvh{};
        packRows(bvh.data(), isInvertible(transform) ? glm::inverse(transform) : mat4(1.0f));
        bvh[3] = {leaf.root, leaf.instance, firstTriangles_[leaf.tree], 0};
        bvhInstances.add<uvec4>(uint64_t{leaf.record} * sizeof(bvh), bvh);
        frame.placements.emplace_back(leaf.record, placementOf(leaf.tree, transform));
    }
}

/// Skinned positions are convex combinations of what single joints give (weights are not negative), so the
/// union of the joints' boxes contains them.
Aabb SceneAnimator::boundsOf(const DeformingInstance& deforming, const Moment& moment) const {
    const Instance& instance = scene_.instances[deforming.instance];
    const std::vector<float>& weights = moment.pose.weights[static_cast<size_t>(instance.node)];
    Aabb result;
    for (const auto& [joint, rest] : deforming.jointBounds) {
        Aabb box = rest;
        for (size_t t = 0; t < deforming.targetBounds.size() && t < weights.size(); ++t)
            box = widened(box, deforming.targetBounds[t], weights[t]);
        const bool moved = instance.skin != none && joint != layout::NONE;
        if (moved && isInRange(box)) box = transformed(box, moment.skins.at(instance.skin)[joint]);
        if (!isInRange(box)) failOutOfRange(instance);
        result.grow(box);
    }
    return result;
}

void SceneAnimator::addMovingTree(const Moment& now, SceneFrame& frame) const {
    if (!motion_.moving) return;  // only lights or cameras move
    std::vector<TopLeaf> leaves;
    std::vector<Aabb> bounds;
    for (const MovingLeaf& leaf : motion_.leaves) bounds.push_back(leaf.bounds);
    for (const DeformingInstance& d : motion_.deforming) bounds[d.leaf] = boundsOf(d, now);
    for (size_t i = 0; i < motion_.leaves.size(); ++i) {
        const mat4& transform = now.transforms[i];
        Aabb box;
        if (isInvertible(transform)) {
            box = transformed(bounds[i], transform);
            if (!isInRange(box)) failOutOfRange(scene_.instances[motion_.leaves[i].instance]);
        }
        leaves.push_back({motion_.leaves[i].record, box});
    }
    const uint32_t firstMoving = motion_.firstTopNode + 1;
    TopTree moving = buildTopTree(leaves, firstMoving, motion_.topStack);
    std::vector<BvhChild> children;
    Aabb all = motion_.stillBounds;
    all.grow(moving.bounds);
    if (!moving.bounds.empty()) children.push_back({BvhRef::node(firstMoving), moving.bounds});
    // Always added; otherwise a scene in which everything moves and nothing is visible would have no node.
    Aabb still = motion_.stillBounds;
    if (still.empty()) still.grow(all.empty() ? vec3(0.0f) : all.center());
    children.push_back({BvhRef::node(motion_.stillRoot), still});
    std::vector<BvhNode> nodes{makeBvhNode(children)};
    nodes.insert(nodes.end(), moving.nodes.begin(), moving.nodes.end());
    addUpload(frame, "quantisedNodes", uint64_t{motion_.firstTopNode} * sizeof(BvhNode), nodes);
    frame.changedNodes.push_back({motion_.firstTopNode, static_cast<uint32_t>(nodes.size())});
    if (motion_.refitNodeCount > 0)
        frame.changedNodes.push_back({motion_.firstRefitNode, motion_.refitNodeCount});
    if (all.empty()) return;
    frame.params.sceneCenter = all.center();
    frame.params.sceneRadius = std::max(0.5f * glm::length(all.size()), 1e-20f);
}

SceneAnimator::Placed SceneAnimator::placed(uint32_t index, const Moment& moment) const {
    const Instance& instance = scene_.instances[index];
    const Mesh& mesh = scene_.meshes[static_cast<size_t>(instance.mesh)];
    Placed result{mesh.positions, moment.pose.toWorld[static_cast<size_t>(instance.node)]};
    if (instance.movement == Movement::Deforming) {
        std::span<const mat4> joints;
        if (instance.skin != none) {
            joints = moment.skins.at(instance.skin);
            result.toWorld = mat4(1.0f);
        }
        result.positions =
            deform(*mesh.deformation, moment.pose.weights[static_cast<size_t>(instance.node)], joints)
                .positions;
    }
    return result;
}

void SceneAnimator::addTriangleLights(const Moment& now, SceneFrame& frame, LightTree& tree) const {
    UploadRuns records(frame, "lights"), densities(frame, "lightDensity");
    for (size_t moving = 0; moving < motion_.lights.size(); ++moving) {
        const MovingLights& lights = motion_.lights[moving];
        const Instance& instance = scene_.instances[lights.instance];
        const Mesh& mesh = scene_.meshes[static_cast<size_t>(instance.mesh)];
        const auto [positions, toWorld] = placed(lights.instance, now);
        const bool mirrored =
            instance.skin == none && isMirrored(now.pose.toWorld[static_cast<size_t>(instance.node)]);
        for (size_t i = 0; i < lights.triangles.size(); ++i) {
            const uint32_t* index = &mesh.indices[size_t{3} * lights.triangles[i]];
            const std::array<vec3, 3> own{positions[index[0]], positions[index[mirrored ? 2 : 1]],
                                          positions[index[mirrored ? 1 : 2]]};
            std::array<vec3, 3> corners{};
            for (size_t k = 0; k < 3; ++k) corners[k] = transformPoint(toWorld, own[k]);
            std::array<uvec4, layout::LIGHT_TEXELS> record{};
            std::copy_n(lightRecords_[moving].begin() + static_cast<std::ptrdiff_t>(i * record.size()),
                        record.size(), record.begin());
            for (size_t k = 0; k < 3; ++k) record[k] = bits(corners[k], record[k].w);
            record[0].w = (record[0].w & layout::LIGHT_KIND_MASK) | (mirrored ? layout::LIGHT_MIRRORED : 0u) |
                          packMagnitude(toWorld, own, corners);
            records.add<uvec4>((lights.firstLight + i) * sizeof(record), record);

            const auto area = static_cast<float>(triangleArea(corners));
            const float density = area > 0.0f ? lights.probabilities[i] / area : 0.0f;
            densities.add<float>((uint64_t{lights.firstDensity} + lights.triangles[i]) * sizeof(float),
                                 std::span(&density, 1));
            if (tree.lightCount() == 0) continue;
            const bool bothSides =
                (record[0].w & layout::LIGHT_KIND_MASK) == layout::LIGHT_TRIANGLE_TWO_SIDED;
            tree.setLight(lights.firstLight + static_cast<uint32_t>(i),
                          triangleLightBounds(corners, double{lights.radiances[i]}, bothSides));
        }
    }
}

void SceneAnimator::addPunctualLights(const Moment& now, SceneFrame& frame, LightTree& tree) const {
    UploadRuns records(frame, "lights");
    for (size_t i = 0; i < scene_.lights.size(); ++i) {
        const PunctualLight& light = scene_.lights[i];
        if (light.node == none) continue;
        const mat4& toWorld = now.pose.toWorld[static_cast<size_t>(light.node)];
        const uvec4* packed = &punctual_[i * layout::LIGHT_TEXELS];
        PunctualLight moved = light;
        moved.position = vec3(toWorld[3]);
        moved.direction = -vec3(withoutScale(toWorld)[2]);
        const std::array<uvec4, layout::LIGHT_TEXELS> record{
            bits(moved.position, packed[0].w), bits(moved.direction, packed[1].w), packed[2], packed[3]};
        records.add<uvec4>(firstPunctual_ * sizeof(uvec4) + i * sizeof(record), record);
        if (tree.lightCount() == 0 || light.kind == PunctualLight::Kind::Directional) continue;
        tree.setLight(static_cast<uint32_t>(firstPunctual_ / layout::LIGHT_TEXELS + i),
                      punctualLightBounds(moved));
    }
}

void SceneAnimator::addLightTree(LightTree& tree, SceneFrame& frame) {
    constexpr uint32_t texels = layout::LIGHT_CHILD_TEXELS;
    const std::vector<uint32_t> changed = tree.refit();
    for (size_t begin = 0, end = 0; begin < changed.size(); begin = end) {
        std::vector<uvec4> packed;
        do {
            packed.resize(packed.size() + texels);
            packLightChild(tree.children()[changed[end]], std::span(packed).last(texels));
            ++end;
        } while (end < changed.size() && changed[end] == changed[end - 1] + 1);
        addUpload(frame, "lightTree", uint64_t{changed[begin]} * texels * sizeof(uvec4), packed);
    }
}

Camera cameraAt(const Scene& scene, const Camera& camera, double time) {
    if (camera.node == none || scene.clip == none) return camera;
    const RigPose pose = evaluate(scene.rig, &scene.rig.clips[static_cast<size_t>(scene.clip)], time);
    Camera result = camera;
    result.toWorld = withoutScale(pose.toWorld[static_cast<size_t>(camera.node)]);
    return result;
}

}  // namespace limpid::scene
