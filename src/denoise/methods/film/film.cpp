#include "denoise/methods/film/film.h"

#include "denoise/methods/film/film_network.h"
#include "denoise/methods/methods.h"

namespace limpid::denoise {

const ParamTable<NetworkSettings>& film::params() {
    static const ParamTable<NetworkSettings> table = networkParams("film");
    return table;
}

DenoiserOutput film::record(gpu::FrameGraph& graph, const DenoiserInput& input,
                            const FilterSettings& settings) {
    return recordNetwork(graph, input, settings, filmNetwork(), settings.film.strength);
}

}  // namespace limpid::denoise
