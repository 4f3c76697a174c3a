#include "denoise/methods/nano/nano.h"

#include "denoise/methods/methods.h"

namespace limpid::denoise {

const ParamTable<NetworkSettings>& nano::params() {
    static const ParamTable<NetworkSettings> table = networkParams("nano");
    return table;
}

DenoiserOutput nano::record(gpu::FrameGraph& graph, const DenoiserInput& input,
                            const FilterSettings& settings) {
    return recordNetwork(graph, input, settings, nanoNetwork(), settings.nano.strength);
}

}  // namespace limpid::denoise
