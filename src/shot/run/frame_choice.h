// Which frames of a shot a request means.
#pragma once

#include <span>

#include "shot/run/shot_request.h"

namespace limpid::shot {

/// Finds the frames, those of them that are asked for and written, and where cuts are. Throws UsageError and
/// InputError.
void chooseFrames(const ShotRequest& request, ShotJob& job);

/// The frames that the user asks for.
std::span<const int> askedFrames(const ShotJob& job);

/// Given cameras and others are in different spaces, so frames without one would spoil the histories of those
/// that are asked for.
void limitRunUpsToCameras(const CameraTrack& cameras, ShotJob& job);

}  // namespace limpid::shot
