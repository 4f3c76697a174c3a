// The ambient-occlusion pass: how open the surroundings of each point of a G-buffer are.
#pragma once

#include "base/params.h"
#include "gpu/graph/frame_graph.h"
#include "passes/gbuffer/gbuffer.h"
#include "scene/device/gpu_scene.h"

namespace limpid {

/// What a user may set; the table below is where range and meaning stand.
struct AmbientOcclusionSettings {
    float radius = 0.2f;
    int rays = 4;
    bool operator==(const AmbientOcclusionSettings&) const = default;
};
const ParamTable<AmbientOcclusionSettings>& ambientOcclusionParams();

/// The random numbers: of the G-buffer's launch. They are not those that the G-buffer draws.
struct AmbientOcclusionLaunch {
    uint32_t stream = 0;
    uint32_t seed = 0;
    bool samplerTea = false;
};

/// rgba32f. rgb: the share of rays that meet nothing, 0..1, as grey; 1 where the camera sees nothing; alpha
/// 0. Rays are cosine-weighted around the shading normal; those that lead into the surface count as stopped.
gpu::ImageHandle ambientOcclusion(gpu::FrameGraph& graph, const scene::GpuScene& scene,
                                  const AmbientOcclusionSettings& settings,
                                  const AmbientOcclusionLaunch& launch, const GBufferImages& gbuffer);

}  // namespace limpid
