#include "renderer/frame.h"

#include "passes/accumulate/accumulate.h"
#include "passes/deform/deform.h"

namespace limpid {
namespace {

float radicalInverse(uint32_t index, uint32_t base) {
    float result = 0.0f, digit = 1.0f;
    for (uint32_t i = index; i > 0; i /= base) {
        digit /= static_cast<float>(base);
        result += digit * static_cast<float>(i % base);
    }
    return result;
}

/// The point inside every pixel, for jitter per frame. Frame 0 goes through the centre.
vec2 frameJitter(Jitter jitter, uint32_t frame) {
    if (jitter != Jitter::Frame || frame == 0) return vec2(0.5f);
    return {radicalInverse(frame, 2), radicalInverse(frame, 3)};
}

}  // namespace

FrameImages recordPathFrame(gpu::FrameGraph& graph, scene::GpuScene& scene, const RenderSettings& settings,
                            const FrameInput& input) {
    if (input.moved) deform(graph, scene, *input.moved);
    const PathtraceLaunch launch{.extent = settings.extent,
                                 .camera = input.camera,
                                 .previousCamera = input.previousCamera,
                                 .hasPrevious = input.hasPrevious,
                                 .frame = input.frame,
                                 .stream = static_cast<uint32_t>(input.stream),
                                 .seed = settings.seed,
                                 .samples = input.samples,
                                 .jitterPerPixel = settings.jitter == Jitter::Pixel,
                                 .jitter = frameJitter(settings.jitter, input.frame)};
    const auto mean = [&](const char* name, gpu::ImageHandle added, VarianceOf varianceOf) {
        return accumulate(graph, name, added, input.samplesBefore, input.samples, varianceOf);
    };
    FrameImages out;
    if (!settings.layers) {
        const PathtraceBeauty traced = pathtraceBeauty(graph, scene, settings.pathtrace, launch);
        out.beauty = mean("beauty", traced.beauty, VarianceOf::Nothing);
        out.counters = traced.counters;
        return out;
    }
    const PathtraceLayers traced = pathtraceLayers(graph, scene, settings.pathtrace, launch);
    out.counters = traced.counters;
    out.ids = traced.ids;
    out.diffuse = mean("diffuse", traced.diffuse, VarianceOf::Luminance);
    out.specular = mean("specular", traced.specular, VarianceOf::Luminance);
    out.emission = mean("emission", traced.emission, VarianceOf::Luminance);
    out.albedo = mean("albedo", traced.albedo, VarianceOf::Luminance);
    out.albedoSpecular = mean("albedoSpecular", traced.albedoSpecular, VarianceOf::Luminance);
    out.normal = mean("normal", traced.normal, VarianceOf::MeanOfComponents);
    out.previousNormal = mean("previousNormal", traced.previousNormal, VarianceOf::Nothing);
    out.depth = mean("depth", traced.depth, VarianceOf::FirstComponent);
    out.motion = mean("motion", traced.motion, VarianceOf::Nothing);
    return out;
}

}  // namespace limpid
