#include "denoise/stages/compose/compose.h"

#include "compose.comp.h"
#include "denoise/stages/compose/compose_params.h"

namespace limpid::denoise {

gpu::ImageHandle compose(gpu::FrameGraph& graph, gpu::ImageHandle scattered, gpu::ImageHandle emission,
                         gpu::ImageHandle disocclusion, bool showDisocclusion) {
    const gpu::Extent extent = graph.extent(scattered);
    const gpu::ImageHandle beauty = graph.transient("compose/beauty", gpu::Format::RGBA32Float, extent);
    const ComposeParams params{extent.width, extent.height, showDisocclusion ? 1u : 0u};
    graph.dispatch({.pass = "compose",
                    .shader = shaders::compose_comp,
                    .bindings = {{"scattered", scattered},
                                 {"emission", emission},
                                 {"disocclusion", disocclusion},
                                 {"beauty", beauty}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = extent});
    return beauty;
}

}  // namespace limpid::denoise
