#include "denoise/stages/ingest/ingest.h"

#include "ingest.comp.h"
#include "ingest_ids.comp.h"
#include "ingest_reflection.comp.h"

namespace limpid::denoise {

using gpu::Format;
using gpu::ImageHandle;

DenoiserInput ingest(gpu::FrameGraph& graph, const IngestImages& images, IngestParams params) {
    const gpu::Extent extent{params.width, params.height};
    const auto make = [&](const char* name, Format format = Format::RGBA32Float) {
        return graph.transient(std::string("ingest/") + name, format, extent);
    };
    DenoiserInput input;
    input.diffuse = make("diffuse");
    input.specular = make("specular");
    input.emission = make("emission");
    input.albedo = make("albedo");
    input.albedoSpecular = make("albedoSpecular");
    input.normal = make("normal");
    input.depth = make("depth");
    input.motion = make("motion");
    input.reflectionMotion = make("reflectionMotion");
    input.previousNormal = make("previousNormal");
    input.ids = make("ids", Format::RG32Uint);
    input.camera = params.camera;

    params.present = 0;
    const auto orRadiance = [&](ImageHandle image, uint bit) {
        if (image) params.present |= bit;
        return image ? image : images.radiance;
    };
    const ImageHandle specular = orRadiance(images.specular, INGEST_SPECULAR);
    const ImageHandle emission = orRadiance(images.emission, INGEST_EMISSION);
    const ImageHandle albedo = orRadiance(images.albedo, INGEST_ALBEDO);
    const ImageHandle albedoSpecular = orRadiance(images.albedoSpecular, INGEST_ALBEDO_SPECULAR);
    const ImageHandle motion = orRadiance(images.motion, INGEST_MOTION);
    const ImageHandle previousNormal = orRadiance(images.previousNormal, INGEST_PREVIOUS_NORMAL);
    const ImageHandle reflectionMotion = orRadiance(images.reflectionMotion, INGEST_REFLECTION_MOTION);
    graph.dispatch({.pass = "ingest",
                    .shader = shaders::ingest_comp,
                    .bindings = {{"radianceIn", images.radiance},
                                 {"specularIn", specular},
                                 {"emissionIn", emission},
                                 {"albedoIn", albedo},
                                 {"albedoSpecularIn", albedoSpecular},
                                 {"normalIn", images.normal},
                                 {"depthIn", images.depth},
                                 {"motionIn", motion},
                                 {"previousNormalIn", previousNormal},
                                 {"reflectionMotionIn", reflectionMotion},
                                 {"diffuse", input.diffuse},
                                 {"specular", input.specular},
                                 {"emission", input.emission},
                                 {"albedo", input.albedo},
                                 {"albedoSpecular", input.albedoSpecular},
                                 {"normal", input.normal},
                                 {"depth", input.depth},
                                 {"motion", input.motion},
                                 {"reflectionMotion", input.reflectionMotion},
                                 {"previousNormal", input.previousNormal},
                                 {"ids", input.ids}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = extent});
    if (images.hitDistance && !images.reflectionMotion) {
        graph.dispatch({.pass = "ingest/reflection",
                        .shader = shaders::ingest_reflection_comp,
                        .bindings = {{"roughnessIn", images.roughness},
                                     {"hitDistanceIn", images.hitDistance},
                                     {"normal", input.normal},
                                     {"depth", input.depth},
                                     {"motion", input.motion},
                                     {"reflectionMotion", input.reflectionMotion}},
                        .params = gpu::paramsOf(params),
                        .constants = {},
                        .extent = extent});
    }
    if (images.id) {
        graph.dispatch({.pass = "ingest/ids",
                        .shader = shaders::ingest_ids_comp,
                        .bindings = {{"idIn", images.id}, {"depth", input.depth}, {"ids", input.ids}},
                        .params = gpu::paramsOf(extent),
                        .constants = {},
                        .extent = extent});
    }
    return input;
}

}  // namespace limpid::denoise
