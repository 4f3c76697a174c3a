// The list of keys, over everything.
#pragma once

#include "viewer/camera/controls.h"

namespace limpid::viewer {

void drawKeyMap(Controls& controls);

}  // namespace limpid::viewer
