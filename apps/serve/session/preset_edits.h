// Presets as edits of the state, for clients: docs/serve-protocol.md.
#pragma once

#include <nlohmann/json.hpp>

namespace limpid::serve {

/// For each preset `name`, `help`, `pipelines`: those that it is for, as "path+svgf", the default one first;
/// and `changes`: the edit that applies it. All presets change the same fields, so one leaves nothing of
/// another. Where the state's pipeline is one of `pipelines`, `integrator` and `denoiser` may be left out.
nlohmann::json presetEdits();

}  // namespace limpid::serve
