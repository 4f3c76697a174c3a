// How mouse and keys move the camera.
#pragma once

#include "studio/camera/gesture.h"

namespace limpid::viewer {

/// What the hand has done to the picture since the last frame of the interface, as ImGui has it. `seconds`:
/// how long that was.
studio::Gesture gestureNow(float seconds);

}  // namespace limpid::viewer
