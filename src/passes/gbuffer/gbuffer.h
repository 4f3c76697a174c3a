// The G-buffer pass: what the camera sees first, and the light that arrives there directly. One primary ray
// per pixel and launch; no bounce.
#pragma once

#include "base/layers/layer_set.h"
#include "base/params.h"
#include "gpu/graph/frame_graph.h"
#include "passes/camera_launch.h"
#include "scene/device/gpu_scene.h"

namespace limpid {

/// What a user may set; the table below is where range and meaning stand.
struct GBufferSettings {
    bool light = true;
    bool shadows = true;
    bool operator==(const GBufferSettings&) const = default;
};
const ParamTable<GBufferSettings>& gbufferParams();

/// Of one sample; rgba32f, alpha 0 unless said otherwise. The layers that follow from the first hit are those
/// of PathtraceLayers (passes/pathtrace/pathtrace.h) for the same launch of one sample: on CPUs bit for bit
/// (but for the sign of 0), elsewhere up to rounding. The other layers are empty.
struct GBufferImages : LayerSet<gpu::ImageHandle> {
    /// Radiance that the surface scatters of what one light sends to it: an unbiased
    /// estimate of light scattered once. A perfectly smooth mirror or pane shows nothing.
    gpu::ImageHandle light;
    gpu::ImageHandle position;         ///< xyz: world space; a: magnitude, for offsetRay(); all 0 at a miss
    gpu::ImageHandle geometricNormal;  ///< of the triangle: unit, on the viewer's side; 0 at a miss
    gpu::ImageHandle counters;         ///< rg32ui: rays and rejected samples since the last reset
};

GBufferImages gbuffer(gpu::FrameGraph& graph, const scene::GpuScene& scene, const GBufferSettings& settings,
                      const CameraLaunch& launch);
/// ... into images made before, for frames of several launches. `countersBefore` are those of the launch
/// before.
void gbuffer(gpu::FrameGraph& graph, const scene::GpuScene& scene, const GBufferSettings& settings,
             const CameraLaunch& launch, gpu::ImageHandle countersBefore, const GBufferImages& into);
/// `given`, and new images for all that it lacks but the counters.
GBufferImages makeGBufferImages(gpu::FrameGraph& graph, gpu::Extent extent, GBufferImages given = {});

}  // namespace limpid
