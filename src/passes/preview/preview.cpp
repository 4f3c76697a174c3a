#include "passes/preview/preview.h"

#include "passes/preview/preview_params.h"
#include "preview.comp.h"

namespace limpid {

gpu::ImageHandle preview(gpu::FrameGraph& graph, const GBufferImages& gbuffer, const CameraParams& camera) {
    const gpu::Extent extent = graph.extent(gbuffer.albedo);
    const gpu::ImageHandle shaded = graph.transient("preview", gpu::Format::RGBA32Float, extent);
    const PreviewParams params{camera, extent.width, extent.height};
    graph.dispatch({.pass = "preview",
                    .shader = shaders::preview_comp,
                    .bindings = {{"albedo", gbuffer.albedo},
                                 {"albedoSpecular", gbuffer.albedoSpecular},
                                 {"emission", gbuffer.emission},
                                 {"normal", gbuffer.normal},
                                 {"position", gbuffer.position},
                                 {"shaded", shaded}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = extent});
    return shaded;
}

}  // namespace limpid
