#include "denoise/stages/taa/taa.h"

#include <algorithm>

#include "denoise/stages/taa/edges.h"
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
             "frames", &TaaSettings::frames, 0.0, 1000.0, "frames",
             "Frames that are averaged to smooth edges; more is smoother and softer, 1 is off, 0 is 2 if the "
             "rays are jittered from frame to frame (--jitter frame), else 1")
            .slider(0, 16);
        t.add("still_frames", &TaaSettings::stillFrames, 1.0, 1000.0, "frames",
              "Frames that are averaged where nothing moves, if the rays are jittered from frame to frame; "
              "more is smoother and calmer")
            .slider(1, 64, SliderScale::Logarithmic);
        t.add("edges", &TaaSettings::edges, 0, 64, "pixels",
              "Length of an edge, in each direction, that is seen to smooth the stairs of surfaces' borders "
              "in each "
              "frame, if the rays are jittered from frame to frame; more is smoother and slower, 0 is off")
            .slider(0, 32);
        return t;
    }();
    return table;
}

float framesToAverage(const TaaSettings& settings, bool jitterChanges) {
    if (settings.frames > 0.0f) return settings.frames;
    return jitterChanges ? 2.0f : 1.0f;
}

ImageHandle targetBeforeTaa(gpu::FrameGraph& graph, const DenoiserInput& input, const TaaSettings& settings) {
    if (framesToAverage(settings, input.jitterChanges) <= 1.0f) return input.target;
    if (input.filters != gpu::Backing::Buffer) return {};
    return graph.transient("taa/aliased", Format::RGBA16Float, graph.extent(input.diffuse));
}

ImageHandle antialias(gpu::FrameGraph& graph, const DenoiserInput& input, ImageHandle beauty,
                      const TaaSettings& settings) {
    const float frames = framesToAverage(settings, input.jitterChanges);
    if (frames <= 1.0f) return beauty;
    const gpu::Extent extent = graph.extent(beauty);
    if (input.jitterChanges && settings.edges > 0)
        beauty = smoothEdges(graph, input, beauty, static_cast<uint32_t>(settings.edges));
    const gpu::History history = graph.history("taa", Format::RGBA16Float, extent, input.filters);
    const ImageHandle result = graph.transient("taa/beauty", Format::RGBA32Float, extent);
    const bool buffers = input.filters == gpu::Backing::Buffer;
    const TaaParams params{extent.width, extent.height, frames, std::max(frames, settings.stillFrames),
                           input.jitter};
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
