// Records passes that trace rays, using the scene's tracer.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "gpu/graph/frame_graph.h"
#include "scene/device/gpu_scene.h"

namespace limpid {

/// The shaders of one pass, one for each tracer.
struct TracerShaders {
    const gpu::ShaderCode& compute;
    const gpu::ShaderCode& rayGeneration;
};

/// Records the pass with the scene's bindings and constants in addition to those given here.
void dispatchTraced(gpu::FrameGraph& graph, const scene::GpuScene& scene, std::string_view pass,
                    const TracerShaders& shaders, const std::vector<gpu::Binding>& images,
                    std::span<const std::byte> params, const std::vector<gpu::ConstantValue>& constants,
                    gpu::Extent extent);

}  // namespace limpid
