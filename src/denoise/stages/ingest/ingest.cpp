#include "denoise/stages/ingest/ingest.h"

#include "ingest.comp.h"
#include "ingest_given_reflection.comp.h"
#include "ingest_moving.comp.h"
#include "ingest_reflection.comp.h"
#include "ingest_white.comp.h"

namespace limpid::denoise {

using gpu::Format;
using gpu::FrameGraph;
using gpu::ImageHandle;

namespace {

ImageHandle make(FrameGraph& graph, const IngestParams& params, const std::string& name, Format format) {
    return graph.transient("ingest/" + name, format, {params.width, params.height});
}

void convertGuides(FrameGraph& graph, const IngestImages& images, const IngestParams& params,
                   DenoiserInput& input) {
    input.normal = make(graph, params, "normal", Format::RGBA16Float);
    input.depth = make(graph, params, "depth", Format::RG32Float);
    input.motion = make(graph, params, "motion", Format::RGBA16Float);
    std::vector<gpu::Binding> bindings{{"normalIn", images.normal},
                                       {"depthIn", images.depth},
                                       {"motionIn", images.motion ? images.motion : images.depth},
                                       {"normal", input.normal},
                                       {"depth", input.depth},
                                       {"motion", input.motion}};
    input.previousNormal = input.normal;
    if (images.previousNormal) {
        input.previousNormal = make(graph, params, "previousNormal", Format::RGBA16Float);
        bindings.insert(bindings.end(), {{"previousNormalIn", images.previousNormal},
                                         {"previousNormal", input.previousNormal}});
    }
    graph.dispatch({.pass = "ingest",
                    .shader = images.previousNormal ? shaders::ingest_moving_comp : shaders::ingest_comp,
                    .bindings = bindings,
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = {params.width, params.height}});
}

ImageHandle givenReflectionMotion(FrameGraph& graph, const IngestImages& images, const IngestParams& params,
                                  const DenoiserInput& input) {
    const ImageHandle motion = make(graph, params, "reflectionMotion", Format::RGBA16Float);
    graph.dispatch({.pass = "ingest/reflection",
                    .shader = shaders::ingest_given_reflection_comp,
                    .bindings = {{"reflectionMotionIn", images.reflectionMotion},
                                 {"depth", input.depth},
                                 {"reflectionMotion", motion}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = {params.width, params.height}});
    return motion;
}

ImageHandle computedReflectionMotion(FrameGraph& graph, const IngestImages& images,
                                     const IngestParams& params, const DenoiserInput& input) {
    const ImageHandle motion = make(graph, params, "reflectionMotion", Format::RGBA16Float);
    graph.dispatch({.pass = "ingest/reflection",
                    .shader = shaders::ingest_reflection_comp,
                    .bindings = {{"roughnessIn", images.roughness},
                                 {"hitDistanceIn", images.hitDistance},
                                 {"normal", input.normal},
                                 {"depth", input.depth},
                                 {"motion", input.motion},
                                 {"reflectionMotion", motion}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = {params.width, params.height}});
    return motion;
}

ImageHandle whiteAlbedo(FrameGraph& graph, const IngestParams& params) {
    const ImageHandle white = make(graph, params, "white", Format::RGBA8Unorm);
    const gpu::Extent extent = graph.extent(white);
    graph.dispatch({.pass = "ingest/white",
                    .shader = shaders::ingest_white_comp,
                    .bindings = {{"white", white}},
                    .params = gpu::paramsOf(extent),
                    .constants = {},
                    .extent = extent});
    return white;
}

}  // namespace

DenoiserInput ingest(FrameGraph& graph, const IngestImages& images, IngestParams params, bool twoSignals) {
    params.hasMotion = images.motion ? 1u : 0u;
    DenoiserInput input;
    input.camera = params.camera;
    convertGuides(graph, images, params, input);
    if (twoSignals && images.reflectionMotion)
        input.reflectionMotion = givenReflectionMotion(graph, images, params, input);
    else if (twoSignals && images.hitDistance)
        input.reflectionMotion = computedReflectionMotion(graph, images, params, input);
    input.ids = images.id;
    input.diffuse = images.radiance;
    input.specular = images.specular;
    input.emission = images.emission;
    input.albedo = images.albedo;
    input.albedoSpecular = images.albedoSpecular;
    const bool needsBoth = twoSignals && !input.albedoSpecular;
    if (!input.albedo || needsBoth) {
        const ImageHandle white = whiteAlbedo(graph, params);
        if (!input.albedo) input.albedo = white;
        if (needsBoth) input.albedoSpecular = white;
    }
    return input;
}

}  // namespace limpid::denoise
