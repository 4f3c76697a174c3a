// Finds a camera for scenes that have none.
#pragma once

#include "scene/model/scene.h"

namespace limpid::scene {

inline constexpr const char* framingCameraName = "framing";

/// Returns a perspective camera of that name that shows the whole scene, including everything its chosen clip
/// moves, in a picture at least as wide as high:
///  - a room closed on all six sides: from inside, at the +Z wall, towards the opposite wall; if something
///  blocks that position, from where most is visible;
///  - a room with one open wall: from outside, straight through the opening;
///  - a scene that is flat along Z: straight from +Z;
///  - everything else: from the front (+Z), slightly from the right and above.
/// A side counts as closed if triangles within 5 % of that side of the bounding box cover half of it. A box
/// whose triangles face outward is a room only if it contains a lamp, or other objects and its walls show
/// their back faces, and if there is space inside.
///
/// Views from outside fill the height of the picture, or a square of that height, except for a margin. If a
/// clip moves objects far away, they fill half of it at the clip's start, and leave the picture.
Camera frameScene(const Scene& scene);

struct BoundingSphere {
    vec3 center{0.0f};
    float radius = 1.0f;
};
/// Returns a sphere around the boxes of all instances at rest.
BoundingSphere boundingSphere(const Scene& scene);

}  // namespace limpid::scene
