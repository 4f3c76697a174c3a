#include "scene/framing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "scene/mesh_repair.h"
#include "scene/occupancy.h"

namespace limpid::scene {
namespace {

/// Above this many triangles only the corners of each mesh's box are looked at.
constexpr size_t maxExactTriangles = size_t{1} << 24;
/// A triangle belongs to a side of the box if it is nearer than this fraction of the box's size.
constexpr float wallDistance = 0.05f;

struct Box {
    vec3 lower{std::numeric_limits<float>::max()};
    vec3 upper{std::numeric_limits<float>::lowest()};
    void grow(const vec3& p) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    bool empty() const { return lower.x > upper.x; }
    vec3 center() const { return 0.5f * (lower + upper); }
    vec3 size() const { return upper - lower; }
    vec3 corner(int i) const {
        return {i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z};
    }
};

vec3 transformed(const mat4& m, const vec3& p) {
    return vec3(m * vec4(p, 1.0f));
}

/// Calls use(a, b, c) with the world positions of each triangle.
template <typename Use>
void forEachTriangle(const Scene& scene, const Use& use) {
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        const auto place = [&](size_t i) {
            return transformed(instance.transform, mesh.positions[mesh.indices[i]]);
        };
        for (size_t i = 0; i < mesh.indices.size(); i += 3) use(place(i), place(i + 1), place(i + 2));
    }
}

Box looseBox(const Scene& scene) {
    std::vector<Box> boxes(scene.meshes.size());
    for (size_t i = 0; i < boxes.size(); ++i) {
        for (const vec3& position : scene.meshes[i].positions) boxes[i].grow(position);
    }
    Box box;
    for (const Instance& instance : scene.instances) {
        const Box& mesh = boxes[static_cast<size_t>(instance.mesh)];
        for (int i = 0; i < 8 && !mesh.empty(); ++i)
            box.grow(transformed(instance.transform, mesh.corner(i)));
    }
    return box;
}

Box exactBox(const Scene& scene) {
    Box box;
    forEachTriangle(scene, [&](const vec3& a, const vec3& b, const vec3& c) {
        box.grow(a);
        box.grow(b);
        box.grow(c);
    });
    return box;
}

/// Of what moves, at so many moments of the clip.
constexpr int clipMoments = 16;

void growByInstance(const Scene& scene, const RigPose& pose, const Instance& instance, Box& box) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    const mat4& toWorld = pose.toWorld[static_cast<size_t>(instance.node)];
    if (instance.movement == Movement::Rigid) {
        for (const vec3& position : mesh.positions) box.grow(transformed(toWorld, position));
        return;
    }
    std::vector<mat4> joints;
    if (instance.skin != none)
        joints = jointMatrices(scene.rig.skins[static_cast<size_t>(instance.skin)], pose);
    const std::vector<float>& weights = pose.weights[static_cast<size_t>(instance.node)];
    for (const vec3& position : deform(*mesh.deformation, weights, joints).positions)
        box.grow(joints.empty() ? transformed(toWorld, position) : position);
}

/// Where the chosen clip takes things.
void growByClip(const Scene& scene, Box& box) {
    if (scene.clip == none) return;
    const Clip& clip = scene.rig.clips[static_cast<size_t>(scene.clip)];
    for (int i = 0; i <= clipMoments; ++i) {
        const RigPose pose = evaluate(scene.rig, &clip, double{clip.duration()} * i / clipMoments);
        for (const Instance& instance : scene.instances) {
            if (instance.movement != Movement::Still) growByInstance(scene, pose, instance, box);
        }
    }
}

/// How much of each side of the box triangles cover, as fractions: -X, +X, -Y, +Y, -Z, +Z.
struct Walls {
    std::array<float, 6> covered{};
    float facingInward = 0.0f;  ///< sum over all sides, triangles that face outward counted negative

    bool isWall(size_t side) const { return covered[side] > 0.5f; }
    bool closed() const {
        return std::all_of(covered.begin(), covered.end(), [](float c) { return c > 0.5f; });
    }
};

Walls findWalls(const Scene& scene, const Box& box) {
    const vec3 size = box.size();
    Walls walls;
    const auto add = [&](int axis, bool isUpper, float area) {
        const float whole = size[(axis + 1) % 3] * size[(axis + 2) % 3];
        if (!(whole > 0.0f)) return;
        walls.covered[static_cast<size_t>(2 * axis + isUpper)] += std::abs(area) / whole;
        walls.facingInward += (isUpper ? -area : area) / whole;
    };
    forEachTriangle(scene, [&](const vec3& a, const vec3& b, const vec3& c) {
        const vec3 area = 0.5f * glm::cross(b - a, c - a);
        const vec3 low = glm::min(a, glm::min(b, c));
        const vec3 high = glm::max(a, glm::max(b, c));
        for (int axis = 0; axis < 3; ++axis) {
            const float near = wallDistance * size[axis];
            if (high[axis] <= box.lower[axis] + near) add(axis, false, area[axis]);
            if (low[axis] >= box.upper[axis] - near) add(axis, true, area[axis]);
        }
    });
    return walls;
}

mat4 lookFrom(const vec3& eye, const vec3& towardsEye) {
    const vec3 back = glm::normalize(towardsEye);
    const vec3 right = glm::normalize(glm::cross(vec3(0, 1, 0), back));
    return {vec4(right, 0), vec4(glm::cross(back, right), 0), vec4(back, 0), vec4(eye, 1)};
}

/// How far from the box's centre the eye must be to see all of it in a square picture.
float fittingDistance(const Box& box, const mat4& view, float fov) {
    const float slope = std::tan(0.5f * fov);
    float distance = 0.0f;
    for (int i = 0; i < 8; ++i) {
        const vec3 offset = box.corner(i) - box.center();
        const float x = std::abs(glm::dot(offset, vec3(view[0])));
        const float y = std::abs(glm::dot(offset, vec3(view[1])));
        distance = std::max(distance, glm::dot(offset, vec3(view[2])) + std::max(x, y) / slope);
    }
    return distance;
}

Camera fromOutside(const Box& box, const vec3& towardsEye) {
    Camera camera;
    camera.verticalFov = pi / 4;
    camera.toWorld = lookFrom(vec3(0.0f), towardsEye);
    const float distance = std::max(1.05f * fittingDistance(box, camera.toWorld, camera.verticalFov), 1e-3f);
    camera.toWorld[3] = vec4(box.center() + distance * vec3(camera.toWorld[2]), 1.0f);
    return camera;
}

constexpr float insideFov = pi / 3;

/// The distance that half of what a camera of `insideFov` shows in a picture of 16:9 exceeds.
float medianDistance(const Occupancy& room, const mat4& view) {
    constexpr int columns = 16, rows = 9;
    const float slope = std::tan(0.5f * insideFov);
    std::array<float, columns * rows> distances{};
    for (int i = 0; i < columns * rows; ++i) {
        const float x = (static_cast<float>(i % columns) + 0.5f) * 2.0f / columns - 1.0f;
        const float y = (static_cast<float>(i / columns) + 0.5f) * 2.0f / rows - 1.0f;
        const vec3 ray = slope * (x * 16.0f / 9.0f * vec3(view[0]) + y * vec3(view[1])) - vec3(view[2]);
        distances[static_cast<size_t>(i)] = room.distanceToSomething(vec3(view[3]), glm::normalize(ray));
    }
    std::nth_element(distances.begin(), distances.begin() + distances.size() / 2, distances.end());
    return distances[distances.size() / 2];
}

/// Of horizontal views from a grid of places where there is some room, the one that shows the most distant
/// things.
mat4 openestView(const Occupancy& room, const Box& box, const mat4& otherwise) {
    constexpr int places = 12, directions = 8, elbowRoom = 2;
    mat4 best = otherwise;
    float farthest = medianDistance(room, otherwise);
    for (int i = 0; i < places * places; ++i) {
        const vec3 at((static_cast<float>(i % places) + 0.5f) / places, 0.5f,
                      (static_cast<float>(i / places) + 0.5f) / places);
        const vec3 eye = box.lower + at * box.size();
        if (!room.isFree(eye, elbowRoom)) continue;
        for (int k = 0; k < directions; ++k) {
            const float angle = 2.0f * pi * static_cast<float>(k) / directions;
            const mat4 view = lookFrom(eye, {std::sin(angle), 0.0f, std::cos(angle)});
            const float distance = medianDistance(room, view);
            // Of equals the first: what stands a little nearer does not matter.
            if (distance > 1.02f * farthest) {
                best = view;
                farthest = distance;
            }
        }
    }
    return best;
}

/// From the front, unless something stands before the eye there: a building has rooms within its box.
Camera fromInside(const Scene& scene, const Box& box) {
    constexpr int cells = 96;
    constexpr float farEnough = 0.3f;  // of the box's depth
    Camera camera;
    camera.verticalFov = insideFov;
    const vec3 eye = box.center() + vec3(0, 0, 0.46f * box.size().z);
    camera.toWorld = lookFrom(eye, {0, 0, 1});
    Occupancy room(box.lower, box.upper, cells);
    forEachTriangle(scene, [&](const vec3& a, const vec3& b, const vec3& c) { room.add(a, b, c); });
    if (medianDistance(room, camera.toWorld) < farEnough * box.size().z)
        camera.toWorld = openestView(room, box, camera.toWorld);
    return camera;
}

/// The side through which a room with one open wall is seen.
std::optional<vec3> openSide(const Walls& walls) {
    const bool left = walls.isWall(0), right = walls.isWall(1), back = walls.isWall(4),
               front = walls.isWall(5);
    if (!walls.isWall(2) || !walls.isWall(3) || left + right + back + front != 3) return std::nullopt;
    if (!front) return vec3(0, 0, 1);
    if (!back) return vec3(0, 0, -1);
    return right ? vec3(-1, 0, 0) : vec3(1, 0, 0);
}

Camera frame(const Scene& scene) {
    const bool isExact = scene.triangleCount() <= maxExactTriangles;
    Box box = isExact ? exactBox(scene) : looseBox(scene);
    if (box.empty()) return {};
    if (isExact) {
        const Walls walls = findWalls(scene, box);
        // A closed box that faces outward is a thing, not a room; thick walls face both ways.
        if (walls.closed() && walls.facingInward > -0.5f) return fromInside(scene, box);
        if (const auto side = openSide(walls)) return fromOutside(box, *side);
    }
    growByClip(scene, box);
    const vec3 size = box.size();
    if (size.z < 0.1f * std::max(size.x, size.y) && size.y > 0.1f * size.x)
        return fromOutside(box, {0, 0, 1});
    return fromOutside(box, {0.5f, 0.4f, 1.0f});
}

}  // namespace

BoundingSphere boundingSphere(const Scene& scene) {
    const Box box = looseBox(scene);
    if (box.empty()) return {};
    return {box.center(), std::max(0.5f * glm::length(box.size()), 1e-20f)};
}

Camera frameScene(const Scene& scene) {
    Camera camera = frame(scene);
    camera.name = framingCameraName;
    return camera;
}

}  // namespace limpid::scene
