#include "denoise/stages/surfaces/surfaces.h"

#include "surfaces.comp.h"
#include "surfaces_buffers.comp.h"

namespace limpid::denoise {

gpu::History makeSurfaces(gpu::FrameGraph& graph, gpu::Extent extent, gpu::Backing filters) {
    return graph.history("surfaces", gpu::Format::RG32Uint, extent, filters);
}

gpu::ImageHandle noIds(gpu::FrameGraph& graph) {
    return graph.history("surfaces/no ids", gpu::Format::R32Uint, {1, 1}).previous;
}

gpu::History recordSurfaces(gpu::FrameGraph& graph, const DenoiserInput& input) {
    if (input.surfaces.current) return input.surfaces;
    const gpu::Extent extent = graph.extent(input.depth);
    const gpu::History result = makeSurfaces(graph, extent, input.filters);
    const bool buffers = input.filters == gpu::Backing::Buffer;
    graph.dispatch({.pass = "surfaces",
                    .shader = buffers ? shaders::surfaces_buffers_comp : shaders::surfaces_comp,
                    .bindings = {{"normal", input.normal},
                                 {"depth", input.depth},
                                 {"ids", input.ids ? input.ids : noIds(graph)},
                                 {"roughness", input.roughness ? input.roughness : input.normal},
                                 {"surfaces", result.current}},
                    .params = gpu::paramsOf(extent),
                    .constants = {{"IDS", input.ids ? 1u : 0u}, {"ROUGHNESS", input.roughness ? 1u : 0u}},
                    .extent = extent});
    return result;
}

}  // namespace limpid::denoise
