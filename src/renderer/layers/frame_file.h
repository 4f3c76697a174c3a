// A frame for denoisers from an EXR file with our layers (docs/layers.md).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "denoise/api/host_frame.h"
#include "image/image.h"

namespace limpid {

/// The frame that the file holds. `sequence`: it has a frame before it, so motion is needed. Throws
/// InputError listing all that is missing of diffuse, specular, emission, albedo, normal, depth, the camera,
/// and motion. Without the layers id and prevNormal there is one object and nothing turns; `lacking` names
/// them.
/// With the layers of variance, and of as many samples as the attribute "limpid.samples" says; of 32 without
/// it.
denoise::HostFrame frameOf(const image::LayeredImage& file, const std::filesystem::path& name, bool sequence,
                           std::vector<std::string>& lacking);

/// Throws InputError listing those of the layers diffuse.variance, specular.variance, albedo.variance,
/// normal.variance and depth.variance that the file lacks: networks need them.
void requireVariances(const image::LayeredImage& file, const std::filesystem::path& name);

}  // namespace limpid
