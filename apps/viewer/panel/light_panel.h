// The panel's part about lights.
#pragma once

#include "viewer/camera/controls.h"
#include "viewer/panel/panel.h"

namespace limpid::viewer {

/// Changes of a light take effect with the next frame; a lamp or a background that is added or taken away
/// loads the scene again.
void drawLights(PanelState& panel, const studio::Facts& facts, Controls& controls);

}  // namespace limpid::viewer
