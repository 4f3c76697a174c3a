// The panel's part about lights.
#pragma once

#include "viewer/panel/panel.h"

namespace limpid::viewer {

/// Every light of the scene. Changes of a light take effect with the next frame; a lamp that is taken away
/// loads the scene again.
void drawLightList(const Drawing& with);

/// A switch, and a colour. Changing it loads the scene again.
void drawBackground(const Drawing& with);

}  // namespace limpid::viewer
