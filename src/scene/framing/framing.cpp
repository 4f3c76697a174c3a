#include "scene/framing/framing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "scene/framing/occupancy.h"
#include "scene/framing/scene_points.h"
#include "scene/framing/tight_view.h"
#include "scene/framing/walls.h"
#include "scene/model/aabb.h"
#include "scene/model/transform.h"

namespace limpid::scene {
namespace {

/// Above this number of triangles, only the corners of each mesh's box are used.
constexpr size_t maxExactTriangles = size_t{1} << 24;

Aabb looseBox(const Scene& scene) {
    std::vector<Aabb> boxes(scene.meshes.size());
    for (size_t i = 0; i < boxes.size(); ++i) {
        for (const vec3& position : scene.meshes[i].positions) boxes[i].grow(position);
    }
    Aabb box;
    for (const Instance& instance : scene.instances) {
        const Aabb& mesh = boxes[static_cast<size_t>(instance.mesh)];
        for (int i = 0; i < 8 && !mesh.empty(); ++i)
            box.grow(transformPoint(instance.transform, mesh.corner(i)));
    }
    return box;
}

/// As sumOver() wants it.
struct BoxSum : Aabb {
    void join(const BoxSum& other) { grow(other); }
};

Aabb exactBox(const Scene& scene) {
    return sumOver(scene, BoxSum{},
                   [](BoxSum& box, const vec3& a, const vec3& b, const vec3& c, const Material&) {
                       box.grow(a);
                       box.grow(b);
                       box.grow(c);
                   });
}

mat4 lookFrom(const vec3& eye, const vec3& towardsEye) {
    const vec3 back = glm::normalize(towardsEye);
    const vec3 right = glm::normalize(glm::cross(vec3(0, 1, 0), back));
    return {vec4(right, 0), vec4(glm::cross(back, right), 0), vec4(back, 0), vec4(eye, 1)};
}

/// Returns the distance from the box's centre at which a square picture shows all of it.
float fittingDistance(const Aabb& box, const mat4& view, float fov) {
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
Camera throughOpening(const Aabb& box, const vec3& towardsEye) {
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
Sum sumOverFirstPoints(const Scene& scene, const Aabb& box, bool isExact, const Sum& empty) {
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
    Aabb box;

    void add(const vec3& point) {
        all.add(point);
        half.add(point);
        box.grow(point);
    }
    void join(const Extents& other) {
        all.join(other.all);
        half.join(other.half);
        box.grow(other.box);
    }
};

/// Moves so close that the whole movement just fits, unless that would make the first pose too small.
Camera fromOutside(const Scene& scene, const Aabb& box, bool isExact, const vec3& towardsEye) {
    constexpr float least = 0.5f;
    Camera camera;
    camera.verticalFov = outsideFov;
    camera.toWorld = lookFrom(vec3(0.0f), towardsEye);
    Extents first = sumOverFirstPoints(
        scene, box, isExact,
        Extents{TightView(camera.toWorld, box.center(), outsideFov, 1.0f - 2.0f * margin),
                TightView(camera.toWorld, box.center(), outsideFov, 1.1f * least), Aabb{}});
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
mat4 openestView(const Occupancy& room, const Aabb& box, const mat4& otherwise) {
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
InsideView fromInside(const Scene& scene, const Aabb& box) {
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
std::optional<Camera> inClosedRoom(const Scene& scene, const Aabb& box, const Walls& walls) {
    if (!walls.closed()) return std::nullopt;
    const InsideView view = fromInside(scene, box);
    const vec3 size = box.size();
    // A closed object may be hollow without being a room.
    if (walls.facesOutward() && view.distance < farEnough * std::min(size.x, size.z)) return std::nullopt;
    return view.camera;
}

Camera frame(const Scene& scene) {
    const bool isExact = scene.triangleCount() <= maxExactTriangles;
    Aabb box = isExact ? exactBox(scene) : looseBox(scene);
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
    const Aabb box = looseBox(scene);
    if (box.empty()) return {};
    return {box.center(), std::max(0.5f * glm::length(box.size()), 1e-20f)};
}

Camera frameScene(const Scene& scene) {
    Camera camera = frame(scene);
    camera.name = framingCameraName;
    return camera;
}

}  // namespace limpid::scene
