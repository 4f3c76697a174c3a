// The shaders that rays of the `hardware` tracer run, shared by all passes.
#pragma once

#include "gpu/graph/frame_graph.h"

namespace limpid {

const gpu::RayShaders& rayShaders();

}  // namespace limpid
