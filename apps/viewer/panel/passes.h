// The panel's part about passes: their times and images.
#pragma once

#include "viewer/panel/panel.h"

namespace limpid::viewer {

/// A click on a pass shows its images; another click shows the picture again.
void drawPasses(const Drawing& with);

}  // namespace limpid::viewer
