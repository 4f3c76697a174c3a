#include "denoise/methods/nano/nano.h"

#include "denoise/methods/methods.h"
#include "denoise/methods/nano/nano_recorder.h"

namespace limpid::denoise {

const ParamTable<NanoSettings>& nano::params() {
    using S = NanoSettings;
    static const ParamTable<S> table = [] {
        ParamTable<S> t("nano");
        t.add("strength", &S::strength, 0.0, 1.0, "",
              "Share of the network's result where it would replace SVGF's; 0 is SVGF alone");
        return t;
    }();
    return table;
}

DenoiserOutput nano::record(gpu::FrameGraph& graph, const DenoiserInput& input,
                            const FilterSettings& settings) {
    const SvgfStages stages = recordSvgfStages(graph, input, settings.svgf);
    return composeSvgf(graph, input, settings, stages,
                       recordNetwork(graph, input, stages, nanoNetwork(), settings.nano.strength));
}

}  // namespace limpid::denoise
