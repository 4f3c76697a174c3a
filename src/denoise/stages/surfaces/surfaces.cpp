#include "denoise/stages/surfaces/surfaces.h"

#include "surfaces.comp.h"
#include "surfaces_buffers.comp.h"

namespace limpid::denoise {

Surfaces makeSurfaces(gpu::FrameGraph& graph, gpu::Extent extent, gpu::Backing filters) {
    return {graph.history("surfaces/normal_distance", gpu::Format::RG32Uint, extent, filters),
            graph.history("surfaces/instances", gpu::Format::R32Uint, extent)};
}

Surfaces recordSurfaces(gpu::FrameGraph& graph, const DenoiserInput& input) {
    if (input.surfaces.surfaces.current) return input.surfaces;
    const gpu::Extent extent = graph.extent(input.depth);
    const Surfaces result = makeSurfaces(graph, extent, input.filters);
    const bool buffers = input.filters == gpu::Backing::Buffer;
    graph.dispatch({.pass = "surfaces",
                    .shader = buffers ? shaders::surfaces_buffers_comp : shaders::surfaces_comp,
                    .bindings = {{"normal", input.normal},
                                 {"depth", input.depth},
                                 {"ids", input.ids ? input.ids : result.instances.previous},  // or not read
                                 {"roughness", input.roughness ? input.roughness : input.normal},
                                 {"surfaces", result.surfaces.current},
                                 {"instances", result.instances.current}},
                    .params = gpu::paramsOf(extent),
                    .constants = {{"IDS", input.ids ? 1u : 0u}, {"ROUGHNESS", input.roughness ? 1u : 0u}},
                    .extent = extent});
    return result;
}

}  // namespace limpid::denoise
