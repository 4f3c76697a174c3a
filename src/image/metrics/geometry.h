// The geometry layers of a frame: the surface that each pixel shows, and its motion since the previous frame.
#pragma once

#include <optional>

#include "base/layers/layer_table.h"
#include "image/image.h"

namespace limpid::image {

/// The value of motion.X and motion.Y in EXR files for a pixel without a position in the previous frame: in
/// the first frame, after a scene cut, or for points behind the previous camera. See validMotion().
inline constexpr float invalidMotion = noValue;

/// Returns whether a motion vector (pixels) is valid: finite, and below a million pixels in each direction.
/// Larger values mark missing motion: invalidMotion, or what other renderers write instead.
bool validMotion(float x, float y);

/// All layers are optional. They have the frame's size.
struct Geometry {
    std::optional<Image> motion;          ///< motion.X Y: previous minus current pixel position, pixels
    std::optional<Image> distanceChange;  ///< motion.Z: previous minus current distance from the eye
    std::optional<Image> depth;           ///< depth.Z: distance from the eye; 1e10 where nothing is hit
    std::optional<Image> normal;          ///< normal.X Y Z: 0 where nothing is hit; need not have unit length
};

/// Returns the geometry layers among a file's channels.
Geometry geometryOf(const LayeredImage& layers);

}  // namespace limpid::image
