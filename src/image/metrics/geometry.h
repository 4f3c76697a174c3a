// The layers that say what surface each pixel of a frame shows, and where that surface was one frame before.
#pragma once

#include <optional>

#include "base/layers/layer_table.h"
#include "image/image.h"

namespace limpid::image {

/// How an EXR file says that a pixel has no place in the previous frame (the first frame, a scene cut, a
/// point behind the previous eye): this value in motion.X and motion.Y. See validMotion.
inline constexpr float invalidMotion = noValue;

/// Whether motion (pixels) is one: finite, and under a million pixels in each direction. What is not is a
/// mark, invalidMotion or another renderer's.
bool validMotion(float x, float y);

/// Each layer is there or not. All are of the frame's size.
struct Geometry {
    std::optional<Image> motion;          ///< motion.X Y: previous pixel position minus this one, pixels
    std::optional<Image> distanceChange;  ///< motion.Z: previous distance minus this one
    std::optional<Image> depth;           ///< depth.Z: distance from the eye; 1e10 where nothing is hit
    std::optional<Image> normal;          ///< normal.X Y Z: 0 where nothing is hit; need not have unit length
};

/// The geometry layers among a file's channels.
Geometry geometryOf(const LayeredImage& layers);

}  // namespace limpid::image
