// The path-tracing pass: light transport by unidirectional path tracing with next-event estimation.
#pragma once

#include "base/params.h"
#include "gpu/graph/frame_graph.h"
#include "passes/camera_launch.h"
#include "passes/pathtrace/pathtrace_params.h"
#include "scene/device/gpu_scene.h"

namespace limpid {

/// What a user may set; the table below is where range and meaning stand.
struct PathtraceSettings {
    int maxDepth = 8;
    int maxTransmissionDepth = 32;
    int rouletteDepth = 3;
    float fireflyClamp = 0.0f;
    bool samplerTea = false;
    bool throughMirrors = true;
    bool operator==(const PathtraceSettings&) const = default;
};
const ParamTable<PathtraceSettings>& pathtraceParams();

/// One launch of the path tracer.
struct PathtraceLaunch : CameraLaunch {
    uint32_t samples = 1;  ///< per pixel in this launch
};

/// Means over the launch's samples, rgba32f. Alpha holds the mean squared deviation of luminance (diffuse,
/// specular, albedo, albedoSpecular, emission) or of the components (normal).
struct PathtraceLayers {
    gpu::ImageHandle diffuse, specular, emission, albedo, albedoSpecular, normal;
    gpu::ImageHandle depth;   ///< x: depth, misses as 0; y: share of hits; a: mean squared deviation of x
    gpu::ImageHandle motion;  ///< xyz: motion, invalid as 0; a: share of valid samples
    gpu::ImageHandle reflectionMotion;  ///< as motion, of what smooth surfaces reflect (docs/layers.md)
    gpu::ImageHandle previousNormal;    ///< xyz: of the same points in the previous frame
    gpu::ImageHandle ids;       ///< rg32ui: instance, material of the first sample; layout::NONE at a miss
    gpu::ImageHandle counters;  ///< rg32ui: rays and rejected samples since the last reset
};
struct PathtraceBeauty {
    gpu::ImageHandle beauty;  ///< mean radiance of the launch's samples; a: the share that met a surface
    gpu::ImageHandle counters;
};

/// The beauty alone; the fast path.
PathtraceBeauty pathtraceBeauty(gpu::FrameGraph& graph, const scene::GpuScene& scene,
                                const PathtraceSettings& settings, const PathtraceLaunch& launch);
/// Every layer.
PathtraceLayers pathtraceLayers(gpu::FrameGraph& graph, const scene::GpuScene& scene,
                                const PathtraceSettings& settings, const PathtraceLaunch& launch);
/// ... into images made before, for frames of several launches. `countersBefore` are those of the launch
/// before.
void pathtraceLayers(gpu::FrameGraph& graph, const scene::GpuScene& scene, const PathtraceSettings& settings,
                     const PathtraceLaunch& launch, gpu::ImageHandle countersBefore,
                     const PathtraceLayers& into);
/// All images but the counters; their names begin with `prefix`.
PathtraceLayers makePathtraceLayers(gpu::FrameGraph& graph, const std::string& prefix, gpu::Extent extent);

}  // namespace limpid
