#include "denoise/methods/film/film.h"

#include "denoise/methods/film/film_network.h"
#include "denoise/methods/methods.h"
#include "denoise/methods/nano/nano_recorder.h"

namespace limpid::denoise {

const ParamTable<FilmSettings>& film::params() {
    using S = FilmSettings;
    static const ParamTable<S> table = [] {
        ParamTable<S> t("film");
        t.add("strength", &S::strength, 0.0, 1.0, "",
              "Share of the network's result where it would replace SVGF's; 0 is SVGF alone");
        return t;
    }();
    return table;
}

DenoiserOutput film::record(gpu::FrameGraph& graph, const DenoiserInput& input,
                            const FilterSettings& settings) {
    const SvgfStages stages = recordSvgfStages(graph, input, settings.svgf);
    return composeSvgf(graph, input, settings, stages,
                       recordNetwork(graph, input, stages, filmNetwork(), settings.film.strength));
}

}  // namespace limpid::denoise
