#include "denoise/stages/ingest/ingest.h"

#include "denoise/stages/surfaces/surfaces.h"
#include "ingest.comp.h"
#include "ingest_buffers.comp.h"
#include "ingest_layers.comp.h"
#include "ingest_reflection.comp.h"
#include "ingest_reflection_buffers.comp.h"
#include "ingest_variance.comp.h"
#include "ingest_white.comp.h"

namespace limpid::denoise {

using gpu::Format;
using gpu::FrameGraph;
using gpu::ImageHandle;

namespace {

ImageHandle make(FrameGraph& graph, const IngestParams& params, const std::string& name, Format format) {
    return graph.transient("ingest/" + name, format, {params.width, params.height});
}

bool inBuffers(const DenoiserInput& input) {
    return input.filters == gpu::Backing::Buffer;
}

/// What is bound in place of motion that the program does not give, and not read.
ImageHandle motionOrAny(const IngestImages& images) {
    return images.motion ? images.motion : images.depth;
}

void convertGuides(FrameGraph& graph, const IngestImages& images, const IngestParams& params, bool layers,
                   DenoiserInput& input) {
    input.surfaces = makeSurfaces(graph, {params.width, params.height}, input.filters);
    const gpu::Extent motionExtent = layers ? gpu::Extent{params.width, params.height} : gpu::Extent{1, 1};
    const ImageHandle motion = graph.transient("ingest/motion", Format::RGBA16Float, motionExtent);
    graph.dispatch({.pass = "ingest",
                    .shader = inBuffers(input) ? shaders::ingest_buffers_comp : shaders::ingest_comp,
                    .bindings = {{"normalIn", images.normal},
                                 {"depthIn", images.depth},
                                 {"motionIn", motionOrAny(images)},
                                 {"idIn", images.id ? images.id : noIds(graph)},
                                 {"roughnessIn", images.roughness ? images.roughness : images.normal},
                                 {"surfaces", input.surfaces.current},
                                 {"motion", motion}},
                    .params = gpu::paramsOf(params),
                    .constants = {{"IDS", images.id ? 1u : 0u},
                                  {"MOTION", layers ? 1u : 0u},
                                  {"ROUGHNESS", images.roughness ? 1u : 0u}},
                    .extent = {params.width, params.height}});
    input.motion = layers ? motion : motionOrAny(images);
    input.motionEncoding = params.motion;
    if (layers) input.motionEncoding.kind = MOTION_LAYER;
}

void addLayers(FrameGraph& graph, const IngestImages& images, const IngestParams& params,
               DenoiserInput& input) {
    input.normal = make(graph, params, "normal", Format::RGBA16Float);
    input.depth = make(graph, params, "depth", Format::RG32Float);
    const gpu::Extent extent = graph.extent(input.depth);
    graph.dispatch({.pass = "ingest/layers",
                    .shader = shaders::ingest_layers_comp,
                    .bindings = {{"normalIn", images.normal},
                                 {"depthIn", images.depth},
                                 {"normal", input.normal},
                                 {"depth", input.depth}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = extent});
}

ImageHandle computedReflectionMotion(FrameGraph& graph, const IngestImages& images,
                                     const IngestParams& params, const DenoiserInput& input) {
    const ImageHandle motion = make(graph, params, "reflectionMotion", Format::RGBA16Float);
    graph.dispatch({.pass = "ingest/reflection",
                    .shader = inBuffers(input) ? shaders::ingest_reflection_buffers_comp
                                               : shaders::ingest_reflection_comp,
                    .bindings = {{"roughnessIn", images.roughness},
                                 {"hitDistanceIn", images.hitDistance},
                                 {"surfaces", input.surfaces.current},
                                 {"motionIn", motionOrAny(images)},
                                 {"reflectionMotion", motion}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = {params.width, params.height}});
    return motion;
}

ImageHandle whiteAlbedo(FrameGraph& graph) {
    const gpu::Extent extent{1, 1};
    const ImageHandle white = graph.transient("ingest/white", Format::RGBA8Unorm, extent);
    graph.dispatch({.pass = "ingest/white",
                    .shader = shaders::ingest_white_comp,
                    .bindings = {{"white", white}},
                    .params = gpu::paramsOf(extent),
                    .constants = {},
                    .extent = extent});
    return white;
}

ImageHandle withVariance(FrameGraph& graph, const IngestParams& params, const std::string& name,
                         ImageHandle light, ImageHandle variance, uint32_t samples) {
    struct {
        uint32_t width, height;
        float ofVariance;
    } const given{params.width, params.height, static_cast<float>(samples - 1)};
    const ImageHandle result = make(graph, params, name, Format::RGBA32Float);
    graph.dispatch({.pass = "ingest/variance " + name,
                    .shader = shaders::ingest_variance_comp,
                    .bindings = {{"lightIn", light}, {"varianceIn", variance}, {"light", result}},
                    .params = gpu::paramsOf(given),
                    .constants = {},
                    .extent = {params.width, params.height}});
    return result;
}

/// Replaces the light by that whose alpha is set (DenoiserInput::variances).
void addVariances(FrameGraph& graph, const IngestImages& images, const IngestParams& params, uint32_t samples,
                  DenoiserInput& input) {
    input.diffuse = withVariance(graph, params, "radiance", input.diffuse, images.radianceVariance, samples);
    if (images.specular) {
        input.specular =
            withVariance(graph, params, "specular", input.specular, images.specularVariance, samples);
    }
    input.samples = samples;
    input.variances = true;
}

}  // namespace

DenoiserInput ingest(FrameGraph& graph, const IngestImages& images, const IngestParams& given,
                     const IngestNeeds& needs) {
    IngestParams params = given;
    params.motion.kind = images.motion ? MOTION_GIVEN : MOTION_STILL;
    params.motion.reflections = images.reflectionMotion ? MOTION_GIVEN : MOTION_LAYER;
    DenoiserInput input;
    input.camera = params.camera;
    input.filters = needs.filters;
    convertGuides(graph, images, params, needs.layers, input);
    input.previousNormal = images.previousNormal;
    input.normalEncoding = params.normals;
    if (needs.twoSignals && images.reflectionMotion)
        input.reflectionMotion = images.reflectionMotion;
    else if (needs.twoSignals && images.hitDistance)
        input.reflectionMotion = computedReflectionMotion(graph, images, params, input);
    if (needs.layers) addLayers(graph, images, params, input);
    input.diffuse = images.radiance;
    input.specular = images.specular;
    input.emission = images.emission;
    input.albedo = images.albedo;
    input.albedoSpecular = images.albedoSpecular;
    input.roughness = images.roughness;
    if (needs.samples > 1 && images.radianceVariance)
        addVariances(graph, images, params, needs.samples, input);
    if (!needs.albedo) return input;
    const bool needsBoth = needs.twoSignals && !input.albedoSpecular;
    if (!input.albedo || needsBoth) {
        const ImageHandle white = whiteAlbedo(graph);
        if (!input.albedo) input.albedo = white;
        if (needsBoth) input.albedoSpecular = white;
    }
    return input;
}

}  // namespace limpid::denoise
