#include "denoise/stages/taa/edges.h"

#include "denoise/stages/taa/edges_params.h"
#include "edges_find.comp.h"
#include "edges_smooth.comp.h"
#include "edges_smooth_buffers.comp.h"

namespace limpid::denoise {

using gpu::Format;
using gpu::ImageHandle;

ImageHandle smoothEdges(gpu::FrameGraph& graph, const DenoiserInput& input, ImageHandle beauty,
                        uint32_t reach) {
    const gpu::Extent extent = graph.extent(beauty);
    const bool halves = input.filters == gpu::Backing::Buffer;
    const EdgesParams params{extent.width, extent.height, reach};
    const ImageHandle edges = graph.transient("edges", Format::R32Uint, extent);
    const ImageHandle smoothed =
        graph.transient("edges/smoothed", halves ? Format::RGBA16Float : Format::RGBA32Float, extent);
    graph.dispatch({.pass = "edges/find",
                    .shader = shaders::edges_find_comp,
                    .bindings = {{"depth", input.depth}, {"normal", input.normal}, {"edges", edges}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = extent});
    graph.dispatch({.pass = "edges/smooth",
                    .shader = halves ? shaders::edges_smooth_buffers_comp : shaders::edges_smooth_comp,
                    .bindings = {{"beauty", beauty}, {"edges", edges}, {"smoothed", smoothed}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = extent});
    return smoothed;
}

}  // namespace limpid::denoise
