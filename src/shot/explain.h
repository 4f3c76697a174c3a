// Says how a file was understood: `limpid denoise --explain`.
#pragma once

#include <string>

#include "shot/motion_check.h"
#include "shot/shot_denoiser.h"

namespace limpid::shot {

/// Several lines: the file, and for each picture its layers with their encoding, what is missing and what
/// that costs, and channels that are not used.
std::string explainLayers(const LoadedFrame& frame);

/// The heading of a picture: its view layer and view.
std::string pictureLine(const LayerMap& map);

/// One or two lines. `searched`: the motion is of MotionSearch, so that its sign is no question.
std::string explainMotion(const MotionCheck& check, int before, int now, bool searched = false);

/// Which variances are estimated for a network; empty if none are.
std::string explainVariances(const LoadedFrame& frame);

/// One line each on the camera, and on light that no layer explains.
std::string explainView(const FrameReport& report);

}  // namespace limpid::shot
