// The whole frame as one recipe.
#pragma once

#include <cstdint>

#include "gpu/frame_graph.h"
#include "renderer/settings.h"
#include "scene/gpu_scene.h"
#include "scene/scene_animator.h"

namespace limpid {

/// Where a progressive render stands.
struct FrameInput {
    CameraParams camera;
    CameraParams previousCamera;
    bool hasPrevious = false;                  ///< there is a previous frame, from which motion is told
    const scene::SceneFrame* moved = nullptr;  ///< what moved since the scene was last traced
    uint32_t frame = 0;                        ///< launches since the last reset
    uint64_t stream = 0;                       ///< of random numbers: `frame`, or beyond in a sequence
    uint64_t samplesBefore = 0;                ///< per pixel, in the running means
    uint32_t samples = 1;                      ///< per pixel, in this frame
};

/// Running means after this frame (passes/pathtrace/pathtrace.h says what the components hold). Without
/// layers only `beauty` and `counters` are set; with layers beauty is the sum of diffuse, specular and
/// emission.
struct FrameImages {
    gpu::ImageHandle beauty, counters;
    gpu::ImageHandle diffuse, specular, emission, albedo, albedoSpecular, normal, previousNormal, depth,
        motion, ids;
};

/// Records one frame of `--pipeline path`.
FrameImages recordPathFrame(gpu::FrameGraph& graph, scene::GpuScene& scene, const RenderSettings& settings,
                            const FrameInput& input);

}  // namespace limpid
