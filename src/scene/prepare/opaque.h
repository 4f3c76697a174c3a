// Materials that only say that they may be transparent.
#pragma once

#include "scene/model/scene.h"

namespace limpid::scene {

/// Makes masked and blended materials opaque whose alpha lets nothing through anywhere: no texel, no vertex.
/// Exporters write many such materials, and rays test each hit on one.
void makeOpaque(Scene& scene);

}  // namespace limpid::scene
