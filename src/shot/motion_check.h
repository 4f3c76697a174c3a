// Whether the motion of a file's layers is what they say: the previous frame, moved, looks like this one.
#pragma once

#include <optional>
#include <string>

#include "shot/frame/shot_frame.h"

namespace limpid::shot {

/// Means over the pixels with motion, of the differences of albedo and normal to the most similar of the 3x3
/// pixels at the same place, and of those to which the motion points.
struct MotionCheck {
    double share = 0.0;      ///< of the pixels that were looked at: those with motion
    double change = 0.0;     ///< between this frame and the previous one
    double explained = 0.0;  ///< share of it that is gone if the previous frame is moved; may be below 0
    /// What explains at least a fifth more, as assignments for --map; empty if nothing does.
    std::string better;
    double betterExplained = 0.0;

    /// So small a change tells nothing.
    bool still() const { return change < 1e-3; }
};

/// None if there is no layer of motion, neither albedo nor normal, or the frames differ in size.
std::optional<MotionCheck> checkMotion(const ShotLayers& before, const ShotLayers& now,
                                       const Encoding& encoding);

/// True if the two frames have nothing to do with each other: less than a quarter of the pixels look like
/// the pixel to which their motion points, or (without motion) like any within five pixels. Without albedo
/// and normal this is not known, and false.
bool isCut(const ShotLayers& before, const ShotLayers& now, const Encoding& encoding);

}  // namespace limpid::shot
