// What rays of the `hardware` tracer run, whichever pass starts them.
#pragma once

#include "gpu/graph/frame_graph.h"

namespace limpid {

const gpu::RayShaders& rayShaders();

}  // namespace limpid
