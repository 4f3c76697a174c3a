#include "denoise/stages/compose/compose.h"

#include "compose.comp.h"
#include "denoise/stages/compose/compose_params.h"

namespace limpid::denoise {

gpu::ImageHandle compose(gpu::FrameGraph& graph, gpu::ImageHandle scattered, gpu::ImageHandle emission,
                         gpu::ImageHandle cases, bool showCases) {
    const gpu::Extent extent = graph.extent(scattered);
    const gpu::ImageHandle beauty = graph.transient("compose/beauty", gpu::Format::RGBA32Float, extent);
    const ComposeParams params{extent.width, extent.height, showCases ? 1u : 0u};
    graph.dispatch(
        {.pass = "compose",
         .shader = shaders::compose_comp,
         .bindings = {{"scattered", scattered}, {"emission", emission}, {"cases", cases}, {"beauty", beauty}},
         .params = gpu::paramsOf(params),
         .constants = {},
         .extent = extent});
    return beauty;
}

}  // namespace limpid::denoise
