// Environment maps: latitude-longitude pictures of the radiance around the scene.
//
// A unit direction d maps to the picture at u = atan2(d.x, -d.z) / (2 pi) + 0.5 from the left and v =
// acos(d.y) / pi from the top, both 0 to 1. So row 0 is +Y, the centre column looks along -Z, and +X is right
// of it.
#pragma once

#include <filesystem>

#include "image/io/rows/memory_bound.h"
#include "scene/model/scene.h"

namespace limpid::scene {

/// Reads .hdr or .exr (image/io/hdr.h), linear Rec. 709. A picture that, with its tables, would take more
/// than `maxMemory` once it is on the device is scaled down while it is decoded, with a warning. Throws
/// InputError if the file is missing or malformed.
Environment loadEnvironment(const std::filesystem::path& path,
                            uint64_t maxMemory = image::defaultImageMemory);

/// Returns a cloudless sky without sun: radiance 1 at the horizon, bluer above, a dim ground below. 64 by 32.
Environment softSky();

/// The mapping described above, and its inverse.
vec2 directionToUv(const vec3& direction);
vec3 uvToDirection(const vec2& uv);

}  // namespace limpid::scene
