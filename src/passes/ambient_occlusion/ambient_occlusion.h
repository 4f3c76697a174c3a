// The ambient-occlusion pass: the unoccluded share of rays from each point of a G-buffer.
#pragma once

#include <span>
#include <vector>

#include "base/params.h"
#include "gpu/graph/frame_graph.h"
#include "passes/gbuffer/gbuffer.h"
#include "scene/device/gpu_scene.h"

namespace limpid {

/// User settings; the table below gives ranges and descriptions.
struct AmbientOcclusionSettings {
    float radius = 0.2f;
    int rays = 4;
    bool operator==(const AmbientOcclusionSettings&) const = default;
};
const ParamTable<AmbientOcclusionSettings>& ambientOcclusionParams();

/// Seed, stream and sample number of the G-buffer's launch. The numbers drawn differ from those of the
/// G-buffer.
struct AmbientOcclusionLaunch {
    uint32_t stream = 0;
    uint32_t seed = 0;
    Sampler sampler = Sampler::Pcg;
    uint32_t firstPoint = 0;  ///< CameraLaunch::firstPoint
};

/// rgba32f. rgb: the share of rays that hit nothing, 0..1, as grey; 1 where the camera sees nothing. alpha:
/// 0. Rays are cosine-weighted around the shading normal. Rays that point into the surface count as occluded.
gpu::ImageHandle ambientOcclusion(gpu::FrameGraph& graph, const scene::GpuScene& scene,
                                  const AmbientOcclusionSettings& settings,
                                  const AmbientOcclusionLaunch& launch, const GBufferImages& gbuffer);
/// Like above, but writes into existing images, for frames of several launches. The last image gets the
/// result; the others hold the intermediate sums of earlier rays.
gpu::ImageHandle ambientOcclusion(gpu::FrameGraph& graph, const scene::GpuScene& scene,
                                  const AmbientOcclusionSettings& settings,
                                  const AmbientOcclusionLaunch& launch, const GBufferImages& gbuffer,
                                  std::span<const gpu::ImageHandle> into);
std::vector<gpu::ImageHandle> makeAmbientOcclusionImages(gpu::FrameGraph& graph,
                                                         const AmbientOcclusionSettings& settings,
                                                         gpu::Extent extent);

/// Ambient occlusion in the form of a light signal that denoisers can filter: rgba32f images that the caller
/// creates.
struct AmbientOcclusionSignal {
    gpu::ImageHandle diffuse;   ///< the unoccluded share; 0 where the camera ray misses
    gpu::ImageHandle albedo;    ///< 1; 0 where the camera ray misses
    gpu::ImageHandle emission;  ///< 1 where the camera ray misses, else 0
    gpu::ImageHandle specular, albedoSpecular, reflectionMotion, hitDistance;  ///< 0
};
/// `openness`: result of ambientOcclusion(). `depth`: from its G-buffer.
void ambientOcclusionSignal(gpu::FrameGraph& graph, gpu::ImageHandle openness, gpu::ImageHandle depth,
                            const AmbientOcclusionSignal& into);

}  // namespace limpid
