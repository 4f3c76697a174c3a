// Methods that are a network behind SVGF, with the filter whose weights it predicts. docs/nano.md has the
// formulas.
#pragma once

#include <string>

#include "denoise/methods/method.h"
#include "denoise/methods/nano/nano_network.h"

namespace limpid::denoise {

/// User settings of such a method; networkParams() gives ranges and descriptions.
struct NetworkSettings {
    float strength = 1.0f;
    bool operator==(const NetworkSettings&) const = default;
};

/// The parameters of the method of this name.
ParamTable<NetworkSettings> networkParams(const std::string& method);

/// Records SVGF with the network behind it.
DenoiserOutput recordNetwork(gpu::FrameGraph& graph, const DenoiserInput& input,
                             const FilterSettings& settings, const NanoNetwork& network, float strength);

}  // namespace limpid::denoise
