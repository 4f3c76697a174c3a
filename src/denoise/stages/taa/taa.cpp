#include "denoise/stages/taa/taa.h"

#include "denoise/stages/taa/taa_params.h"
#include "taa.comp.h"
#include "taa_buffers.comp.h"

namespace limpid::denoise {

using gpu::Format;
using gpu::ImageHandle;

const ParamTable<TaaSettings>& taaParams() {
    static const auto table = [] {
        ParamTable<TaaSettings> t("taa");
        t.add(
             "frames", &TaaSettings::frames, 1.0, 1000.0, "frames",
             "Frames that are averaged to smooth edges (2 is best with --jitter frame); more is smoother and "
             "softer, 1 is off")
            .slider(1, 64, SliderScale::Logarithmic);
        return t;
    }();
    return table;
}

ImageHandle antialias(gpu::FrameGraph& graph, const DenoiserInput& input, ImageHandle beauty,
                      const TaaSettings& settings) {
    if (settings.frames <= 1.0f) return beauty;
    const gpu::Extent extent = graph.extent(beauty);
    const gpu::History history = graph.history("taa", Format::RGBA16Float, extent, input.filters);
    const ImageHandle result = graph.transient("taa/beauty", Format::RGBA32Float, extent);
    const bool buffers = input.filters == gpu::Backing::Buffer;
    const TaaParams params{extent.width, extent.height, settings.frames, input.jitter};
    graph.dispatch({.pass = "taa",
                    .shader = buffers ? shaders::taa_buffers_comp : shaders::taa_comp,
                    .bindings = {{"beauty", beauty},
                                 {"depth", input.depth},
                                 {"motion", input.motion},
                                 {"before", history.previous},
                                 {"after", history.current},
                                 {"smoothed", result}},
                    .params = gpu::paramsOf(params),
                    .constants = {},
                    .extent = extent});
    return result;
}

}  // namespace limpid::denoise
