// The panel beside the picture: what is rendered, how, and how long it takes.
#pragma once

#include <string>
#include <vector>

#include "gpu/frame_graph.h"
#include "renderer/settings.h"

namespace limpid::viewer {

/// What the panel shows and changes.
struct PanelState {
    RenderSettings render;
    uint32_t samples = 1;      ///< per pixel and frame
    float exposure = 0.0f;     ///< stops
    float verticalFov = 0.8f;  ///< radians
    bool measureExposure = false, resetCamera = false,
         screenshot = false;  ///< asked for; whoever does it clears it
    bool shown = true;
};

/// What it only shows.
struct PanelFacts {
    std::string device;
    uint64_t samplesInMean = 0;  ///< 0 where nothing accumulates
    double frameMilliseconds = 0.0;
    std::vector<gpu::PassTime> passes;
    std::string fault;  ///< of the last thing that failed
};

/// ImGui's calls for it.
void drawPanel(PanelState& state, const PanelFacts& facts);

}  // namespace limpid::viewer
