// A camera for scenes that have none.
#pragma once

#include "scene/model/scene.h"

namespace limpid::scene {

inline constexpr const char* framingCameraName = "framing";

/// A perspective camera of that name that shows the whole scene, and all that its chosen clip moves, in a
/// picture at least as wide as high:
///  - a room closed on all six sides: from inside, at the +Z wall, towards the opposite wall; if something
///    stands near before that place, from where most can be seen;
///  - a room with one open wall: from outside, straight through the opening;
///  - a scene that is flat along Z: straight from +Z;
///  - everything else: from the front (+Z), a little to the right and above.
/// A side counts as closed if triangles within 5 % of that side of the bounding box cover half of it. A
/// box whose triangles face outward is a room only if a lamp is in it, or other things and its walls show
/// their backs, and if there is room inside.
///
/// What is seen from outside fills the height of the picture, or a square of that height, but for a margin.
/// Where a clip takes things far away, they fill half of it as the clip begins, and leave the picture.
Camera frameScene(const Scene& scene);

struct BoundingSphere {
    vec3 center{0.0f};
    float radius = 1.0f;
};
/// Around the boxes of all instances at rest.
BoundingSphere boundingSphere(const Scene& scene);

}  // namespace limpid::scene
