// The panel's sections, in the order in which one uses them.
#pragma once

#include "viewer/panel/panel.h"

namespace limpid::viewer {

void drawSections(const Drawing& with);

}  // namespace limpid::viewer
