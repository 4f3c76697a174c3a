// What closes the sides of a scene's box: a room, or an object.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <optional>

#include "scene/model/aabb.h"
#include "scene/model/scene.h"

namespace limpid::scene {

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

/// `box` holds all triangles of the scene at rest.
Walls findWalls(const Scene& scene, const Aabb& box);

/// Returns the direction of the side through which a room with one open wall is seen.
std::optional<vec3> openSide(const Walls& walls);

}  // namespace limpid::scene
