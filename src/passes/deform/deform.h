// Moves the scene to a point in time: uploads what moved, poses vertices on the device, and refits their
// trees.
#pragma once

#include "gpu/graph/frame_graph.h"
#include "scene/device/gpu_scene.h"
#include "scene/motion/scene_animator.h"

namespace limpid {

/// Records the passes "deform/pose", "deform/refit" and, for the `hardware` tracer, "deform/structures".
/// Later passes of this graph, and later frames, see the scene in the state of `frame`.
void deform(gpu::FrameGraph& graph, scene::GpuScene& scene, const scene::SceneFrame& frame);

}  // namespace limpid
