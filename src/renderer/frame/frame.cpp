#include "renderer/frame/frame.h"

#include <algorithm>
#include <array>
#include <functional>

#include "passes/accumulate/accumulate.h"
#include "passes/deform/deform.h"
#include "passes/light_distances/light_distances.h"
#include "passes/preview/preview.h"

namespace limpid {
namespace {

using gpu::FrameGraph;
using gpu::ImageHandle;

/// The stream of random numbers of a launch. Numbers repeat after 2^32 launches, which are so many frames
/// apart that nothing compares or averages them.
uint32_t streamOf(uint64_t launch) {
    return static_cast<uint32_t>(launch);
}

CameraLaunch cameraLaunch(const RenderSettings& settings, const FrameInput& input) {
    return {.extent = settings.extent,
            .camera = input.camera,
            .previousCamera = input.previousCamera,
            .hasPrevious = input.hasPrevious,
            .firstSample = input.firstSample,
            .firstPoint = input.firstPoint,
            .stream = streamOf(input.stream),
            .seed = settings.seed,
            .jitter = settings.jitter,
            .jitterSpan = input.jitterSpan,
            .samplesBefore = input.raysBefore,
            .sampler = settings.pathtrace.sampler()};
}

/// Replaces the layers in `out` by running means.
void accumulateLayers(FrameGraph& graph, const FrameInput& input, FrameImages& out) {
    for (const LayerInfo& layer : frameLayers) {
        ImageHandle& image = out[layer];
        if (!image || !layer.isMean()) continue;
        image = accumulate(graph, std::string(layer.member), image, input.samplesBefore, input.samples,
                           layer.varianceOf);
    }
}

/// Records the path tracer alone, with running means over frames.
FrameImages recordPath(FrameGraph& graph, const scene::GpuScene& scene, const RenderSettings& settings,
                       const FrameInput& input) {
    const PathtraceLaunch launch{cameraLaunch(settings, input), input.samples};
    FrameImages out;
    if (!settings.layers) {
        const PathtraceBeauty traced = pathtraceBeauty(graph, scene, settings.pathsTraced(), launch);
        out.beauty = accumulate(graph, "beauty", traced.beauty, input.samplesBefore, input.samples,
                                VarianceOf::Nothing);
        out.counters = traced.counters;
        return out;
    }
    static_cast<PathtraceLayers&>(out) = pathtraceLayers(graph, scene, settings.pathsTraced(), launch);
    accumulateLayers(graph, input, out);
    return out;
}

/// Records first hits, with direct light if `light` is set. Layers, if requested, are running means.
GBufferImages recordGBuffer(FrameGraph& graph, const scene::GpuScene& scene, const RenderSettings& settings,
                            const FrameInput& input, bool light, FrameImages& out) {
    GBufferSettings used = settings.gbuffer;
    used.light = used.light && light;
    const GBufferImages seen = gbuffer(graph, scene, used, cameraLaunch(settings, input));
    out.counters = seen.counters;
    for (const LayerInfo& layer : frameLayers) {
        if (layer.inBeauty ? light : settings.layers) out[layer] = seen[layer];
    }
    if (light) {
        out.diffuse = seen.light;
        out.depth = seen.depth;
    }
    accumulateLayers(graph, input, out);
    return seen;
}

/// Puts all scattered light in `diffuse`.
FrameImages recordLit(FrameGraph& graph, const scene::GpuScene& scene, const RenderSettings& settings,
                      const FrameInput& input) {
    FrameImages out;
    recordGBuffer(graph, scene, settings, input, true, out);
    return out;
}

FrameImages recordAmbientOcclusion(FrameGraph& graph, const scene::GpuScene& scene,
                                   const RenderSettings& settings, const FrameInput& input) {
    FrameImages out;
    const GBufferImages seen = recordGBuffer(graph, scene, settings, input, false, out);
    const ImageHandle open = ambientOcclusion(
        graph, scene, settings.ambientOcclusion,
        {streamOf(input.stream), settings.seed, settings.pathtrace.sampler(), input.firstPoint}, seen);
    out.beauty =
        accumulate(graph, "ambient_occlusion", open, input.samplesBefore, input.samples, VarianceOf::Nothing);
    return out;
}

FrameImages recordPreview(FrameGraph& graph, const scene::GpuScene& scene, const RenderSettings& settings,
                          const FrameInput& input) {
    FrameImages out;
    const GBufferImages seen = recordGBuffer(graph, scene, settings, input, false, out);
    out.beauty = accumulate(graph, "preview", preview(graph, seen, input.camera), input.samplesBefore,
                            input.samples, VarianceOf::Nothing);
    return out;
}

/// Records one launch of a denoiser's input. `before` are the counters of the previous launch.
using Launch = std::function<void(const PathtraceLaunch&, ImageHandle before, const PathtraceLayers& into)>;

GBufferImages withGuides(GBufferImages images, const PathtraceLayers& layers) {
    images.normal = layers.normal;
    images.depth = layers.depth;
    images.motion = layers.motion;
    images.previousNormal = layers.previousNormal;
    images.roughness = layers.roughness;
    images.ids = layers.ids;
    images.counters = layers.counters;
    return images;
}

/// Records launches of one sample each: ambient occlusion as the light of white surfaces, and the guides of
/// the first hit. `layers`: those of one of the launches.
Launch occlusionLaunch(FrameGraph& graph, const scene::GpuScene& scene, const RenderSettings& settings,
                       const PathtraceLayers& layers) {
    const auto openness = makeAmbientOcclusionImages(graph, settings.ambientOcclusion, settings.extent);
    const GBufferImages images = makeGBufferImages(graph, settings.extent, withGuides({}, layers));
    return [&, openness, images](const PathtraceLaunch& launch, ImageHandle before,
                                 const PathtraceLayers& into) {
        const GBufferImages seen = withGuides(images, into);
        GBufferSettings used = settings.gbuffer;
        used.light = false;
        gbuffer(graph, scene, used, launch, before, seen);
        const ImageHandle open = ambientOcclusion(
            graph, scene, settings.ambientOcclusion,
            {launch.stream, settings.seed, launch.sampler, launch.firstPoint}, seen, openness);
        ambientOcclusionSignal(graph, open, into.depth,
                               {.diffuse = into.diffuse,
                                .albedo = into.albedo,
                                .emission = into.emission,
                                .specular = into.specular,
                                .albedoSpecular = into.albedoSpecular,
                                .reflectionMotion = into.reflectionMotion,
                                .hitDistance = into.hitDistance});
    };
}

Launch pathLaunch(FrameGraph& graph, const scene::GpuScene& scene, const RenderSettings& settings) {
    return [&](const PathtraceLaunch& launch, ImageHandle before, const PathtraceLayers& into) {
        pathtraceLayers(graph, scene, settings.pathsTraced(), launch, before, into);
    };
}

/// Records a frame's samples in as many launches as the device and the integrator require, and averages them.
PathtraceLayers traceSamples(FrameGraph& graph, const scene::GpuScene& scene, const RenderSettings& settings,
                             const FrameInput& input) {
    const gpu::Extent extent = settings.extent;
    PathtraceLaunch launch{cameraLaunch(settings, input), input.samples};
    const bool paths = settings.pipeline.integrator != Integrator::AmbientOcclusion;
    const gpu::History counters =
        graph.history(paths ? "pathtrace/counters" : "gbuffer/counters", gpu::Format::RG32Uint, extent);
    const bool once = input.samples <= input.launchSamples;
    const bool forFilters = once && paths && !settings.layers && !settings.pipeline.usesNetwork();
    PathtraceLayers traced = makePathtraceLayers(graph, "pathtrace/", extent, forFilters);
    traced.counters = counters.current;
    const Launch record =
        paths ? pathLaunch(graph, scene, settings) : occlusionLaunch(graph, scene, settings, traced);
    if (once) {
        record(launch, counters.previous, traced);
        return traced;
    }
    std::array<PathtraceLayers, 2> means{makePathtraceLayers(graph, "mean/", extent),
                                         makePathtraceLayers(graph, "other mean/", extent)};
    for (PathtraceLayers* layers : {&means[0], &means[1], &traced})
        layers->counters =
            graph.transient(graph.name(layers->ids) + " counters", gpu::Format::RG32Uint, extent);
    ImageHandle countersBefore = counters.previous;
    const ImageHandle ids = means[0].ids;  // from the first launch
    for (uint32_t done = 0, number = 0; done < input.samples; ++number) {
        launch.samples = std::min(input.launchSamples, input.samples - done);
        launch.stream = streamOf(input.stream + number);
        launch.firstSample = input.firstSample + done;
        launch.firstPoint = input.firstPoint + done;
        launch.samplesBefore = done;
        PathtraceLayers& mean = means[number % 2];
        PathtraceLayers& into = number == 0 ? mean : traced;
        into.counters = done + launch.samples == input.samples ? counters.current : mean.counters;
        record(launch, countersBefore, into);
        countersBefore = into.counters;
        for (const LayerInfo& layer : frameLayers) {
            if (number == 0 || !layer.isMean()) continue;
            accumulateStep(graph, std::string(layer.member),
                           {.before = means[1 - number % 2][layer],
                            .added = traced[layer],
                            .after = mean[layer],
                            .countBefore = static_cast<float>(done),
                            .countAdded = static_cast<float>(launch.samples),
                            .varianceOf = layer.varianceOf});
        }
        done += launch.samples;
        if (done < input.samples) continue;
        mean.ids = ids;
        mean.counters = counters.current;
        return mean;
    }
    return means[0];
}

/// Returns the mean offset of rays from the pixels' centres, with Jitter::Frame.
vec2 meanPoint(uint32_t first, uint32_t count, float span) {
    vec2 sum(0.0f);
    for (uint32_t i = 0; i < count; ++i) sum += framePoint(first + i, span);
    return sum / static_cast<float>(count);
}

/// Records samples and a denoiser, which keeps its histories from frame to frame.
FrameImages recordDenoised(FrameGraph& graph, const scene::GpuScene& scene, const RenderSettings& settings,
                           const FrameInput& input) {
    FrameImages out;
    static_cast<PathtraceLayers&>(out) = traceSamples(graph, scene, settings, input);
    denoise::DenoiserInput frame{{out}, input.camera, input.samples};
    frame.variances = input.samples > 1;
    frame.choose(input.filters);
    frame.jitterChanges = settings.jitter == Jitter::Frame;
    if (frame.jitterChanges) frame.jitter = meanPoint(input.firstSample, input.samples, input.jitterSpan);
    frame.reasons = {.wanted = input.reasons, .cut = !input.hasPrevious};
    out.firstDenoisingPass = graph.passes().size();
    const denoise::DenoiserOutput denoised =
        settings.pipeline.denoiser->record(graph, frame, settings.denoisers, settings.networks);
    out.beauty = denoised.beauty;
    out.disocclusion = denoised.disocclusion;
    out.reasons = denoised.reasons;
    return out;
}

}  // namespace

std::optional<vec2> jitterOf(const RenderSettings& settings, uint64_t number, uint64_t samples) {
    if (settings.jitter != Jitter::Frame) return std::nullopt;
    const auto first = static_cast<uint32_t>(std::min<uint64_t>(number * samples, UINT32_MAX));
    return meanPoint(first, static_cast<uint32_t>(samples), jitterSpanOf(samples));
}

FrameImages recordFrame(FrameGraph& graph, scene::GpuScene& scene, const RenderSettings& settings,
                        const FrameInput& input) {
    if (input.moved) deform(graph, scene, *input.moved);
    if (scene.lightDistancesStale()) lightDistances(graph, scene);
    if (settings.pipeline.denoiser) return recordDenoised(graph, scene, settings, input);
    switch (settings.pipeline.integrator) {
        case Integrator::Path:
        case Integrator::Direct:
            return recordPath(graph, scene, settings, input);
        case Integrator::AmbientOcclusion:
            return recordAmbientOcclusion(graph, scene, settings, input);
        case Integrator::GBuffer:
            return recordLit(graph, scene, settings, input);
        case Integrator::Preview:
            break;
    }
    return recordPreview(graph, scene, settings, input);
}

}  // namespace limpid
