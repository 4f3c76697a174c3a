// What is shown in place of the picture where there is no scene.
#pragma once

#include "viewer/panel/panel.h"
#include "viewer/start/thumbnails.h"

namespace limpid::viewer {

void drawStartPage(const Drawing& with, const Thumbnails& thumbnails);

}  // namespace limpid::viewer
