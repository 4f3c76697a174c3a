// The points of a scene, at rest and while its clip plays.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <cstddef>
#include <vector>

#include "scene/model/scene.h"
#include "scene/model/transform.h"
#include "scene/motion/animation.h"
#include "scene/motion/deformation.h"

namespace limpid::scene {

using TriangleRange = tbb::blocked_range<size_t>;

/// Calls use(a, b, c, material) with the world positions of triangles of the instance, at rest.
template <typename Use>
void forEachTriangle(const Scene& scene, const Instance& instance, const TriangleRange& triangles,
                     const Use& use) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    const auto place = [&](size_t i) {
        return transformPoint(instance.transform, mesh.positions[mesh.indices[i]]);
    };
    for (size_t i = triangles.begin(); i < triangles.end(); ++i) {
        const size_t slot = mesh.materialSlots.empty() ? 0 : mesh.materialSlots[i];
        use(place(3 * i), place(3 * i + 1), place(3 * i + 2),
            scene.materials[static_cast<size_t>(instance.material) + slot]);
    }
}

inline TriangleRange trianglesOf(const Scene& scene, const Instance& instance) {
    constexpr size_t onOneThread = size_t{1} << 16;
    return {0, scene.meshes[static_cast<size_t>(instance.mesh)].triangleCount(), onOneThread};
}

template <typename Use>
void forEachTriangle(const Scene& scene, const Use& use) {
    for (const Instance& instance : scene.instances)
        forEachTriangle(scene, instance, trianglesOf(scene, instance), use);
}

/// A sum over the triangles of an instance, on all cores: calls add(sum, a, b, c, material), and
/// sum.join(other) with sums that began with `empty`, too. Does not depend on the threads.
template <typename Sum, typename Add>
Sum sumOver(const Scene& scene, const Instance& instance, const Sum& empty, const Add& add) {
    const auto sumOf = [&](const TriangleRange& triangles, Sum sum) {
        forEachTriangle(scene, instance, triangles,
                        [&](const vec3& a, const vec3& b, const vec3& c, const Material& material) {
                            add(sum, a, b, c, material);
                        });
        return sum;
    };
    const TriangleRange all = trianglesOf(scene, instance);
    if (!all.is_divisible()) return sumOf(all, empty);
    return tbb::parallel_deterministic_reduce(all, empty, sumOf, [](Sum sum, const Sum& other) {
        sum.join(other);
        return sum;
    });
}

template <typename Sum, typename Add>
Sum sumOver(const Scene& scene, const Sum& empty, const Add& add) {
    Sum sum = empty;
    for (const Instance& instance : scene.instances) sum.join(sumOver(scene, instance, empty, add));
    return sum;
}

/// The number of times in the clip at which moving objects are checked.
constexpr int clipMoments = 16;

/// Calls use(point) with each vertex of a moving instance.
template <typename Use>
void forEachMovedPoint(const Scene& scene, const RigPose& pose, const Instance& instance, const Use& use) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    const mat4& toWorld = pose.toWorld[static_cast<size_t>(instance.node)];
    if (instance.movement == Movement::Rigid) {
        for (const vec3& position : mesh.positions) use(transformPoint(toWorld, position));
        return;
    }
    std::vector<mat4> joints;
    if (instance.skin != none)
        joints = jointMatrices(scene.rig.skins[static_cast<size_t>(instance.skin)], pose);
    const std::vector<float>& weights = pose.weights[static_cast<size_t>(instance.node)];
    for (const vec3& position : deform(*mesh.deformation, weights, joints).positions)
        use(joints.empty() ? transformPoint(toWorld, position) : position);
}

/// Calls use(point, moment) with the positions of moving objects at moments 0 to clipMoments of the clip.
template <typename Use>
void forEachClipPoint(const Scene& scene, const Use& use) {
    if (scene.clip == none) return;
    const Clip& clip = scene.rig.clips[static_cast<size_t>(scene.clip)];
    for (int i = 0; i <= clipMoments; ++i) {
        const RigPose pose = evaluate(scene.rig, &clip, double{clip.duration()} * i / clipMoments);
        for (const Instance& instance : scene.instances) {
            if (instance.movement == Movement::Still) continue;
            forEachMovedPoint(scene, pose, instance, [&](const vec3& point) { use(point, i); });
        }
    }
}

}  // namespace limpid::scene
