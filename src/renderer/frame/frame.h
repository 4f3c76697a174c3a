// The whole frame as one recipe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "gpu/graph/frame_graph.h"
#include "passes/pathtrace/pathtrace.h"
#include "renderer/frame/settings.h"
#include "scene/device/gpu_scene.h"
#include "scene/motion/scene_animator.h"

namespace limpid {

/// Where a render stands.
struct FrameInput {
    CameraParams camera;
    CameraParams previousCamera;
    bool hasPrevious = false;                    ///< there is a previous frame, from which motion is told
    const scene::SceneFrame* moved = nullptr;    ///< what moved since the scene was last traced
    uint32_t firstSample = 0;                    ///< per pixel since the last reset, before this frame
    uint64_t stream = 0;                         ///< of random numbers; no two launches have the same
    uint64_t samplesBefore = 0;                  ///< per pixel, in the running means
    uint32_t samples = 1;                        ///< per pixel, in this frame
    uint32_t launchSamples = UINT32_MAX;         ///< ... of these in one launch at most, before a denoiser
    gpu::Backing filters = gpu::Backing::Image;  ///< of images that filters read many times over
};

/// What a frame leaves on the device; images that a pipeline does not make are empty. `path` and `direct`
/// without layers make `beauty` and `counters`; with layers beauty is the sum of diffuse, specular and
/// emission. These are running means without a denoiser, and this frame's own with one.
struct FrameImages : PathtraceLayers {
    gpu::ImageHandle beauty;

    /// Of one of frameLayers, or of beautyLayer.
    gpu::ImageHandle& operator[](const LayerInfo& layer) {
        return layer.index == beautyLayer.index ? beauty : LayerSet::operator[](layer);
    }
    const gpu::ImageHandle& operator[](const LayerInfo& layer) const {
        return layer.index == beautyLayer.index ? beauty : LayerSet::operator[](layer);
    }

    gpu::ImageHandle disocclusion;  ///< denoise::TemporalImages::disocclusion
    /// From this pass of the graph on they are the denoiser's; none without one.
    std::optional<size_t> firstDenoisingPass;
};

/// Records one frame of settings.pipeline.
FrameImages recordFrame(gpu::FrameGraph& graph, scene::GpuScene& scene, const RenderSettings& settings,
                        const FrameInput& input);

}  // namespace limpid
