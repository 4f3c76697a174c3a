// `nano` with a larger network: for sequences offline and for stills, of 1 to 64 samples. docs/film.md has
// the network and how it was trained.
#pragma once

#include "denoise/methods/nano/nano_recorder.h"

namespace limpid::denoise {

/// The entry in the list of methods (methods.h). Passes: those of nano, with names that begin with "film/".
namespace film {
using Settings = NetworkSettings;
inline constexpr std::string_view help =
    "SVGF, and behind it a larger trained network: for stills and films, slow";
inline constexpr std::array<std::string_view, 3> groups{"film", "svgf", "taa"};
const ParamTable<Settings>& params();
inline constexpr bool readsLayers = false;
inline constexpr bool readsVariances = true;
inline constexpr bool oneChannel = false;
inline constexpr bool keepsHistory = true;
inline constexpr uint32_t samples = 16;
DenoiserOutput record(gpu::FrameGraph& graph, const DenoiserInput& input, const FilterSettings& settings);
}  // namespace film

}  // namespace limpid::denoise
