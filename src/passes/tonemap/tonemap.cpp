#include "passes/tonemap/tonemap.h"

#include <cmath>

#include "passes/tonemap/tonemap_params.h"
#include "tonemap.comp.h"
#include "tonemap_extended.comp.h"

namespace limpid {

namespace {

gpu::ImageHandle dispatchTo(gpu::FrameGraph& graph, const gpu::ShaderCode& shader, gpu::Format format,
                            gpu::ImageHandle radiance, gpu::ImageHandle added, float stops, uint32_t curve) {
    const gpu::Extent extent = graph.extent(radiance);
    const gpu::ImageHandle display = graph.transient("tonemap", format, extent);
    const TonemapParams params{extent.width, extent.height, std::exp2(stops), curve};
    graph.dispatch(
        {.pass = "tonemap",
         .shader = shader,
         .bindings = {{"radiance", radiance}, {"added", added ? added : radiance}, {"display", display}},
         .params = gpu::paramsOf(params),
         .constants = {{"SUM_OF_TWO", added ? 1u : 0u}},
         .extent = extent});
    return display;
}

}  // namespace

gpu::ImageHandle tonemap(gpu::FrameGraph& graph, gpu::ImageHandle radiance, float stops,
                         gpu::ImageHandle added, image::ToneCurve curve) {
    return dispatchTo(graph, shaders::tonemap_comp, gpu::Format::RGBA8Unorm, radiance, added, stops,
                      static_cast<uint32_t>(curve));
}

gpu::ImageHandle tonemapExtended(gpu::FrameGraph& graph, gpu::ImageHandle radiance, float stops,
                                 gpu::ImageHandle added) {
    return dispatchTo(graph, shaders::tonemap_extended_comp, gpu::Format::RGBA16Float, radiance, added, stops,
                      0);
}

}  // namespace limpid
