#include "denoise/stages/compose/compose.h"

#include "compose.comp.h"
#include "compose_buffers.comp.h"
#include "compose_float.comp.h"
#include "compose_half.comp.h"
#include "compose_half_buffers.comp.h"
#include "compose_half_float.comp.h"
#include "denoise/stages/compose/compose_params.h"

namespace limpid::denoise {
namespace {

const gpu::ShaderCode& shaderFor(const gpu::FrameGraph& graph, gpu::ImageHandle light,
                                 gpu::ImageHandle beauty) {
    const bool half = graph.format(beauty) == gpu::Format::RGBA16Float;
    if (graph.format(light) == gpu::Format::RGBA32Float)
        return half ? shaders::compose_half_float_comp : shaders::compose_float_comp;
    if (graph.backing(light) == gpu::Backing::Buffer)
        return half ? shaders::compose_half_buffers_comp : shaders::compose_buffers_comp;
    return half ? shaders::compose_half_comp : shaders::compose_comp;
}

}  // namespace

gpu::ImageHandle compose(gpu::FrameGraph& graph, const std::string& pass, const ComposeInput& input) {
    const gpu::Extent extent = graph.extent(input.light);
    const gpu::ImageHandle beauty =
        input.target ? input.target : graph.transient(pass, gpu::Format::RGBA32Float, extent);
    const auto orAny = [&](gpu::ImageHandle image, gpu::ImageHandle other) { return image ? image : other; };
    const ComposeParams params{extent.width, extent.height, input.minAlbedo};
    const bool both = input.secondAlbedo && !input.second;
    graph.dispatch({.pass = pass,
                    .shader = shaderFor(graph, input.light, beauty),
                    .bindings = {{"lightA", input.light},
                                 {"lightB", orAny(input.second, input.light)},
                                 {"albedoA", input.albedo},
                                 {"albedoB", orAny(input.secondAlbedo, input.albedo)},
                                 {"emission", orAny(input.emission, input.albedo)},
                                 {"beauty", beauty}},
                    .params = gpu::paramsOf(params),
                    .constants = {{"ALBEDOS", both ? 2u : 1u},
                                  {"SECOND", input.second ? 1u : 0u},
                                  {"EMISSION", input.emission ? 1u : 0u}},
                    .extent = extent});
    return beauty;
}

}  // namespace limpid::denoise
