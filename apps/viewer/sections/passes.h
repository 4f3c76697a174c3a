// The panel's part about passes: their times and images.
#pragma once

#include "viewer/panel/panel.h"

namespace limpid::viewer {

/// The images of a pass are shown while the pointer rests on it. A click keeps them, and another one shows
/// the picture again.
void drawPasses(const Drawing& with);

/// Where the list is not drawn: shows again what was shown before the pointer came over it.
void endPassPreview(PanelState& panel);

}  // namespace limpid::viewer
