// Records all passes of one frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gpu/graph/frame_graph.h"
#include "passes/pathtrace/pathtrace.h"
#include "renderer/method/settings.h"
#include "scene/device/gpu_scene.h"
#include "scene/motion/scene_animator.h"

namespace limpid {

/// The inputs of one frame.
struct FrameInput {
    CameraParams camera;
    CameraParams previousCamera;
    bool hasPrevious = false;                  ///< there is a previous frame to compute motion from
    const scene::SceneFrame* moved = nullptr;  ///< what moved since the scene was last traced
    uint32_t firstSample = 0;                  ///< per pixel since the last reset, before this frame
    uint64_t raysBefore = 0;                   ///< per pixel in this picture, before this frame
    uint32_t firstPoint = 0;                   ///< CameraLaunch::firstPoint
    float jitterSpan = 1.0f;                   ///< CameraLaunch::jitterSpan
    uint64_t stream = 0;                       ///< the launch's number, for streamOf(): modulo 2^32
    uint64_t samplesBefore = 0;                ///< per pixel, in the running means
    uint32_t samples = 1;                      ///< per pixel, in this frame
    uint32_t launchSamples = UINT32_MAX;       ///< maximum per launch, if a denoiser follows
    gpu::FilterChoice filters;                 ///< from gpu::filterChoice(device)
    bool reasons = false;  ///< for debugging: the denoiser also tells why it kept or rejected histories
};

/// The images that a frame leaves on the device; those that a pipeline does not compute are empty. Without
/// layers, `path` and `direct` compute only `beauty` and `counters`; with layers, beauty is the sum of
/// diffuse, specular and emission. Without a denoiser the images are running means; with one they show this
/// frame only.
struct FrameImages : PathtraceLayers {
    gpu::ImageHandle beauty;

    /// The image of one of frameLayers, or of beautyLayer.
    gpu::ImageHandle& operator[](const LayerInfo& layer) {
        return layer.index == beautyLayer.index ? beauty : LayerSet::operator[](layer);
    }
    const gpu::ImageHandle& operator[](const LayerInfo& layer) const {
        return layer.index == beautyLayer.index ? beauty : LayerSet::operator[](layer);
    }

    gpu::ImageHandle disocclusion;                ///< denoise::TemporalImages::disocclusion
    std::vector<denoise::SignalReasons> reasons;  ///< denoise::DenoiserOutput::reasons
    /// Index of the denoiser's first pass in the graph; empty without a denoiser.
    std::optional<size_t> firstDenoisingPass;
};

/// With Jitter::Frame, the mean offset from the pixels' centres of the rays of frame `number`, if each frame
/// has `samples`; pixels, y down.
std::optional<vec2> jitterOf(const RenderSettings& settings, uint64_t number, uint64_t samples);

/// Records one frame of settings.pipeline.
FrameImages recordFrame(gpu::FrameGraph& graph, scene::GpuScene& scene, const RenderSettings& settings,
                        const FrameInput& input);

}  // namespace limpid
