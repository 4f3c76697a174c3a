// A network behind SVGF: it sees what SVGF has accumulated and filtered, predicts the weights of a filter on
// five resolutions, and how much of SVGF's result to replace by that. docs/nano.md has the architecture and
// how it was trained.
#pragma once

#include "denoise/methods/nano/nano_recorder.h"

namespace limpid::denoise {

/// The entry in the list of methods (methods.h). Passes: those of SVGF, with "nano/features" and so on before
/// "svgf/compose".
namespace nano {
using Settings = NetworkSettings;
inline constexpr std::string_view help =
    "SVGF, and behind it a small trained network: cleaner and sharper, slower";
inline constexpr std::array<std::string_view, 3> groups{"nano", "svgf", "taa"};
const ParamTable<Settings>& params();
inline constexpr bool readsLayers = false;
inline constexpr bool readsVariances = true;
inline constexpr bool oneChannel = false;
inline constexpr bool keepsHistory = true;
inline constexpr uint32_t samples = 1;
DenoiserOutput record(gpu::FrameGraph& graph, const DenoiserInput& input, const FilterSettings& settings);
}  // namespace nano

}  // namespace limpid::denoise
