#include "passes/tonemap/tonemap.h"

#include <cmath>

#include "passes/tonemap/tonemap_params.h"
#include "tonemap.comp.h"

namespace limpid {

gpu::ImageHandle tonemap(gpu::FrameGraph& graph, gpu::ImageHandle radiance, float stops,
                         gpu::ImageHandle added, image::ToneCurve curve) {
    const gpu::Extent extent = graph.extent(radiance);
    const gpu::ImageHandle display = graph.transient("tonemap", gpu::Format::RGBA8Unorm, extent);
    const TonemapParams params{extent.width, extent.height, std::exp2(stops), static_cast<uint32_t>(curve)};
    graph.dispatch(
        {.pass = "tonemap",
         .shader = shaders::tonemap_comp,
         .bindings = {{"radiance", radiance}, {"added", added ? added : radiance}, {"display", display}},
         .params = gpu::paramsOf(params),
         .constants = {{"SUM_OF_TWO", added ? 1u : 0u}},
         .extent = extent});
    return display;
}

}  // namespace limpid
