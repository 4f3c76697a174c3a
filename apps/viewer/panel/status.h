// The status at the panel's lower end: what is being computed, messages and errors.
#pragma once

#include "viewer/panel/panel.h"

namespace limpid::viewer {

/// Sets PanelState::statusHeight, for the next picture of the window.
void drawStatus(const Drawing& with);

}  // namespace limpid::viewer
