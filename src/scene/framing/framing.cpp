#include "scene/framing/framing.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include "scene/framing/occupancy.h"
#include "scene/framing/tight_view.h"
#include "scene/prepare/mesh_repair.h"

namespace limpid::scene {
namespace {

/// Above this number of triangles, only the corners of each mesh's box are used.
constexpr size_t maxExactTriangles = size_t{1} << 24;
/// A triangle belongs to a side of the box if its distance is below this fraction of the box's size.
constexpr float wallDistance = 0.05f;

struct Box {
    vec3 lower{std::numeric_limits<float>::max()};
    vec3 upper{std::numeric_limits<float>::lowest()};
    void grow(const vec3& p) {
        lower = glm::min(lower, p);
        upper = glm::max(upper, p);
    }
    void join(const Box& other) {
        lower = glm::min(lower, other.lower);
        upper = glm::max(upper, other.upper);
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

using Triangles = tbb::blocked_range<size_t>;

/// Calls use(a, b, c, material) with the world positions of triangles of the instance, at rest.
template <typename Use>
void forEachTriangle(const Scene& scene, const Instance& instance, const Triangles& triangles,
                     const Use& use) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    const auto place = [&](size_t i) {
        return transformed(instance.transform, mesh.positions[mesh.indices[i]]);
    };
    for (size_t i = triangles.begin(); i < triangles.end(); ++i) {
        const size_t slot = mesh.materialSlots.empty() ? 0 : mesh.materialSlots[i];
        use(place(3 * i), place(3 * i + 1), place(3 * i + 2),
            scene.materials[static_cast<size_t>(instance.material) + slot]);
    }
}

Triangles trianglesOf(const Scene& scene, const Instance& instance) {
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
    const auto sumOf = [&](const Triangles& triangles, Sum sum) {
        forEachTriangle(scene, instance, triangles,
                        [&](const vec3& a, const vec3& b, const vec3& c, const Material& material) {
                            add(sum, a, b, c, material);
                        });
        return sum;
    };
    const Triangles all = trianglesOf(scene, instance);
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
    return sumOver(scene, Box{}, [](Box& box, const vec3& a, const vec3& b, const vec3& c, const Material&) {
        box.grow(a);
        box.grow(b);
        box.grow(c);
    });
}

/// The number of times in the clip at which moving objects are checked.
constexpr int clipMoments = 16;

/// Calls use(point) with each vertex of a moving instance.
template <typename Use>
void forEachMovedPoint(const Scene& scene, const RigPose& pose, const Instance& instance, const Use& use) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    const mat4& toWorld = pose.toWorld[static_cast<size_t>(instance.node)];
    if (instance.movement == Movement::Rigid) {
        for (const vec3& position : mesh.positions) use(transformed(toWorld, position));
        return;
    }
    std::vector<mat4> joints;
    if (instance.skin != none)
        joints = jointMatrices(scene.rig.skins[static_cast<size_t>(instance.skin)], pose);
    const std::vector<float>& weights = pose.weights[static_cast<size_t>(instance.node)];
    for (const vec3& position : deform(*mesh.deformation, weights, joints).positions)
        use(joints.empty() ? transformed(toWorld, position) : position);
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

/// The fraction of each side of the box that triangles cover: -X, +X, -Y, +Y, -Z, +Z.
struct Walls {
    std::array<float, 6> covered{};
    float facingInward = 0.0f;    ///< sum over all sides; triangles that face outward count as negative
    float seenFromBehind = 0.0f;  ///< like facingInward, but only for triangles that show their back faces
    bool somethingInside = false, lightInside = false;

    bool isWall(size_t side) const { return covered[side] > 0.5f; }
    bool closed() const {
        return std::all_of(covered.begin(), covered.end(), [](float c) { return c > 0.5f; });
    }
    /// A closed box that faces outward is an object, not a room; thick walls face both ways.
    bool facesOutward() const { return facingInward <= -0.5f; }
    /// True if such a box contains furniture that is visible from inside, or a lamp, and so is a room after
    /// all.
    bool hidesSomething() const {
        return lightInside || (somethingInside && seenFromBehind > 0.5f * covering());
    }
    void join(const Walls& other) {
        for (size_t i = 0; i < covered.size(); ++i) covered[i] += other.covered[i];
        facingInward += other.facingInward;
        seenFromBehind += other.seenFromBehind;
        somethingInside |= other.somethingInside;
        lightInside |= other.lightInside;
    }

  private:
    float covering() const { return std::accumulate(covered.begin(), covered.end(), 0.0f); }
};

Walls findWalls(const Scene& scene, const Box& box) {
    const vec3 size = box.size();
    const auto isInside = [&](const vec3& point) {
        const vec3 margin = 2.0f * wallDistance * size;
        return glm::all(glm::greaterThan(point, box.lower + margin)) &&
               glm::all(glm::lessThan(point, box.upper - margin));
    };
    const auto cover = [&](Walls& walls, int axis, bool isUpper, float area, bool bothSides) {
        const float whole = size[(axis + 1) % 3] * size[(axis + 2) % 3];
        if (!(whole > 0.0f)) return;
        walls.covered[static_cast<size_t>(2 * axis + isUpper)] += std::abs(area) / whole;
        walls.facingInward += (isUpper ? -area : area) / whole;
        if (bothSides) walls.seenFromBehind += std::abs(area) / whole;
    };
    const auto add = [&](Walls& walls, const vec3& a, const vec3& b, const vec3& c,
                         const Material& material) {
        if (isInside(a) && isInside(b) && isInside(c)) {
            walls.somethingInside = true;
            walls.lightInside |= material.emission != vec3(0.0f);
            return;
        }
        const vec3 area = 0.5f * glm::cross(b - a, c - a);
        const vec3 low = glm::min(a, glm::min(b, c));
        const vec3 high = glm::max(a, glm::max(b, c));
        for (int axis = 0; axis < 3; ++axis) {
            const float near = wallDistance * size[axis];
            if (high[axis] <= box.lower[axis] + near)
                cover(walls, axis, false, area[axis], material.doubleSided);
            if (low[axis] >= box.upper[axis] - near)
                cover(walls, axis, true, area[axis], material.doubleSided);
        }
    };
    Walls walls = sumOver(scene, Walls{}, add);
    for (const PunctualLight& light : scene.lights)
        walls.lightInside |= light.kind != PunctualLight::Kind::Directional && isInside(light.position);
    return walls;
}

mat4 lookFrom(const vec3& eye, const vec3& towardsEye) {
    const vec3 back = glm::normalize(towardsEye);
    const vec3 right = glm::normalize(glm::cross(vec3(0, 1, 0), back));
    return {vec4(right, 0), vec4(glm::cross(back, right), 0), vec4(back, 0), vec4(eye, 1)};
}

/// Returns the distance from the box's centre at which a square picture shows all of it.
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

constexpr float outsideFov = pi / 4;
/// The fraction of the picture that stays free on each side.
constexpr float margin = 1.0f / 42.0f;

/// Looks into a room straight through its opening.
Camera throughOpening(const Box& box, const vec3& towardsEye) {
    Camera camera;
    camera.verticalFov = outsideFov;
    camera.toWorld = lookFrom(vec3(0.0f), towardsEye);
    const float distance = std::max(1.05f * fittingDistance(box, camera.toWorld, camera.verticalFov), 1e-3f);
    camera.toWorld[3] = vec4(box.center() + distance * vec3(camera.toWorld[2]), 1.0f);
    return camera;
}

/// Adds everything visible at the clip's start to `empty`, by add(point) and join(other); of a very large
/// scene, the corners of its box.
template <typename Sum>
Sum sumOverFirstPoints(const Scene& scene, const Box& box, bool isExact, const Sum& empty) {
    Sum sum = empty;
    for (int i = 0; i < 8 && !isExact; ++i) sum.add(box.corner(i));
    for (const Instance& instance : scene.instances) {
        if (!isExact || (scene.clip != none && instance.movement != Movement::Still)) continue;
        sum.join(sumOver(scene, instance, empty,
                         [](Sum& part, const vec3& a, const vec3& b, const vec3& c, const Material&) {
                             part.add(a);
                             part.add(b);
                             part.add(c);
                         }));
    }
    forEachClipPoint(scene, [&](const vec3& point, int moment) {
        if (moment == 0) sum.add(point);
    });
    return sum;
}

/// What fromOutside() must know of all points.
struct Extents {
    TightView all, half;
    Box box;

    void add(const vec3& point) {
        all.add(point);
        half.add(point);
        box.grow(point);
    }
    void join(const Extents& other) {
        all.join(other.all);
        half.join(other.half);
        box.join(other.box);
    }
};

/// Moves so close that the whole movement just fits, unless that would make the first pose too small.
Camera fromOutside(const Scene& scene, const Box& box, bool isExact, const vec3& towardsEye) {
    constexpr float least = 0.5f;
    Camera camera;
    camera.verticalFov = outsideFov;
    camera.toWorld = lookFrom(vec3(0.0f), towardsEye);
    Extents first =
        sumOverFirstPoints(scene, box, isExact,
                           Extents{TightView(camera.toWorld, box.center(), outsideFov, 1.0f - 2.0f * margin),
                                   TightView(camera.toWorld, box.center(), outsideFov, 1.1f * least), Box{}});
    TightView& all = first.all;
    forEachClipPoint(scene, [&](const vec3& point, int) { all.add(point); });
    const float diagonal = glm::length(first.box.size());
    const float room = diagonal > 0.0f ? 0.05f * diagonal : 1e-3f;
    camera.toWorld[3] = vec4(all.eye(room), 1.0f);
    const PictureSize size = sumOverFirstPoints(scene, box, isExact, PictureSize(camera.toWorld, outsideFov));
    if (size.largest() < least) camera.toWorld[3] = vec4(first.half.eye(room), 1.0f);
    return camera;
}

constexpr float insideFov = pi / 3;
/// The minimum median distance of a view inside a room, as a fraction of the box's depth.
constexpr float farEnough = 0.3f;

/// Returns the median distance in the view of a camera with `insideFov` and a picture of 16:9.
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

/// Returns the horizontal view with the largest median distance, among positions on a grid with some space
/// around them.
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
            // Prefers the first of nearly equal views.
            if (distance > 1.02f * farthest) {
                best = view;
                farthest = distance;
            }
        }
    }
    return best;
}

/// A camera in a room, and the median distance in its view.
struct InsideView {
    Camera camera;
    float distance = 0.0f;
};

/// Looks from the front, unless something blocks the view there: a building may have rooms within its box.
InsideView fromInside(const Scene& scene, const Box& box) {
    constexpr int cells = 96;
    Camera camera;
    camera.verticalFov = insideFov;
    const vec3 eye = box.center() + vec3(0, 0, 0.46f * box.size().z);
    camera.toWorld = lookFrom(eye, {0, 0, 1});
    Occupancy room(box.lower, box.upper, cells);
    forEachTriangle(scene,
                    [&](const vec3& a, const vec3& b, const vec3& c, const Material&) { room.add(a, b, c); });
    if (medianDistance(room, camera.toWorld) < farEnough * box.size().z)
        camera.toWorld = openestView(room, box, camera.toWorld);
    return {camera, medianDistance(room, camera.toWorld)};
}

/// Returns nothing if the scene is not a closed room.
std::optional<Camera> inClosedRoom(const Scene& scene, const Box& box, const Walls& walls) {
    if (!walls.closed()) return std::nullopt;
    const InsideView view = fromInside(scene, box);
    const vec3 size = box.size();
    // A closed object may be hollow without being a room.
    if (walls.facesOutward() && view.distance < farEnough * std::min(size.x, size.z)) return std::nullopt;
    return view.camera;
}

/// Returns the side through which a room with one open wall is seen.
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
        const bool isRoom = !walls.facesOutward() || walls.hidesSomething();
        const auto inside = isRoom ? inClosedRoom(scene, box, walls) : std::nullopt;
        if (inside) return *inside;
        const auto side = isRoom ? openSide(walls) : std::nullopt;
        if (side) return throughOpening(box, *side);
    }
    forEachClipPoint(scene, [&](const vec3& point, int) { box.grow(point); });
    const vec3 size = box.size();
    const bool isFlat = size.z < 0.1f * std::max(size.x, size.y) && size.y > 0.1f * size.x;
    return fromOutside(scene, box, isExact, isFlat ? vec3(0, 0, 1) : vec3(0.5f, 0.6f, 1.0f));
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
