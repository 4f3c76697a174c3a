// The G-buffer pass: the first hit of each camera ray, and the direct light there. One primary ray per pixel
// and launch; no bounce.
#pragma once

#include "base/layers/layer_set.h"
#include "base/params.h"
#include "gpu/graph/frame_graph.h"
#include "passes/camera_launch.h"
#include "scene/device/gpu_scene.h"

namespace limpid {

/// User settings; the table below gives ranges and descriptions.
struct GBufferSettings {
    bool light = true;
    bool shadows = true;
    bool operator==(const GBufferSettings&) const = default;
};
const ParamTable<GBufferSettings>& gbufferParams();

/// Images of one sample; rgba32f with alpha 0 unless stated otherwise. Layers that depend only on the first
/// hit equal those of PathtraceLayers (passes/pathtrace/pathtrace.h) for the same launch of one sample: bit
/// for bit on CPUs (except for the sign of 0), up to rounding elsewhere. The other layers are empty.
struct GBufferImages : LayerSet<gpu::ImageHandle> {
    /// Radiance scattered at the surface from one sampled light: an unbiased estimate of single scattering.
    /// Perfectly smooth mirrors and panes are black.
    gpu::ImageHandle light;
    gpu::ImageHandle position;         ///< xyz: world space; a: magnitude, for offsetRay(); all 0 at a miss
    gpu::ImageHandle geometricNormal;  ///< the triangle's unit normal on the viewer's side; 0 at a miss
    gpu::ImageHandle counters;         ///< rg32ui: rays and rejected samples since the last reset
};

GBufferImages gbuffer(gpu::FrameGraph& graph, const scene::GpuScene& scene, const GBufferSettings& settings,
                      const CameraLaunch& launch);
/// Like above, but writes into existing images, for frames of several launches. `countersBefore`: counters of
/// the previous launch.
void gbuffer(gpu::FrameGraph& graph, const scene::GpuScene& scene, const GBufferSettings& settings,
             const CameraLaunch& launch, gpu::ImageHandle countersBefore, const GBufferImages& into);
/// Adds new images for all empty handles in `given` except the counters.
GBufferImages makeGBufferImages(gpu::FrameGraph& graph, gpu::Extent extent, GBufferImages given = {});

}  // namespace limpid
