// What colours mean that stand for numbers, drawn as rows of the panel.
#pragma once

#include "viewer/camera/controls.h"

namespace limpid::viewer {

/// The colours of the tone curve "false-color" and their stops.
void drawStopLegend(Controls& controls);

/// The colours of a pass in false colors, and the values at their ends. `stops`: values are multiplied with 2
/// to its power before they become colours from 0 to 1.
void drawColormapLegend(Controls& controls, float stops);

}  // namespace limpid::viewer
