// The path-tracing pass: light transport by unidirectional path tracing with next-event estimation.
#pragma once

#include "base/layers/layer_set.h"
#include "base/params.h"
#include "gpu/graph/frame_graph.h"
#include "passes/camera_launch.h"
#include "passes/pathtrace/pathtrace_params.h"
#include "scene/device/gpu_scene.h"

namespace limpid {

/// User settings; the table below gives ranges and descriptions.
struct PathtraceSettings {
    int maxDepth = 8;
    int maxTransmissionDepth = 32;
    int rouletteDepth = 3;
    float fireflyClamp = 0.0f;
    bool samplerTea = false;
    bool samplerSobol = true;
    bool throughMirrors = true;
    bool throughGlass = true;
    bool lightTree = true;
    Sampler sampler() const {
        if (samplerTea) return Sampler::Tea;
        return samplerSobol ? Sampler::Sobol : Sampler::Pcg;
    }
    bool operator==(const PathtraceSettings&) const = default;
};
const ParamTable<PathtraceSettings>& pathtraceParams();

/// One launch of the path tracer.
struct PathtraceLaunch : CameraLaunch {
    uint32_t samples = 1;  ///< per pixel in this launch
};

/// Every layer of base/layers/layer_table.h: means over the launch's samples, rgba32f (Mean and VarianceOf
/// say what the components are). `ids` is rg32ui: instance, material of the first sample; layout::NONE at a
/// miss.
struct PathtraceLayers : LayerSet<gpu::ImageHandle> {
    gpu::ImageHandle counters;  ///< rg32ui: rays and rejected samples since the last reset
};
struct PathtraceBeauty {
    gpu::ImageHandle beauty;  ///< mean radiance of the launch's samples; a: the share that hit a surface
    gpu::ImageHandle counters;
};

/// Renders only the beauty; the fast path.
PathtraceBeauty pathtraceBeauty(gpu::FrameGraph& graph, const scene::GpuScene& scene,
                                const PathtraceSettings& settings, const PathtraceLaunch& launch);
/// Renders every layer.
PathtraceLayers pathtraceLayers(gpu::FrameGraph& graph, const scene::GpuScene& scene,
                                const PathtraceSettings& settings, const PathtraceLaunch& launch);
/// Like above, but writes into existing images, for frames of several launches. `countersBefore`: counters of
/// the previous launch.
void pathtraceLayers(gpu::FrameGraph& graph, const scene::GpuScene& scene, const PathtraceSettings& settings,
                     const PathtraceLaunch& launch, gpu::ImageHandle countersBefore,
                     const PathtraceLayers& into);
/// Creates all images except the counters; their names begin with `prefix`. `forFilters`: only what filters
/// read, and in halves where LayerInfo::forFilters says so (the path tracer's launches alone can write that).
PathtraceLayers makePathtraceLayers(gpu::FrameGraph& graph, const std::string& prefix, gpu::Extent extent,
                                    bool forFilters = false);

}  // namespace limpid
