// A frame for denoisers from an EXR file with our layers (docs/layers.md).
#pragma once

#include <filesystem>
#include <vector>

#include "denoise/api/host_frame.h"
#include "image/image.h"

namespace limpid {

/// The frame that the file holds. `sequence`: it has a frame before it. Throws InputError if the camera is
/// missing, or layers that denoising needs (base/layers/layer_table.h: Need), listing all of these. Missing
/// layers that are advised in a sequence are added to `lacking`: without `id` there is one object, without
/// `prevNormal` nothing turns. With the layers of variance, and of as many samples as the attribute
/// "limpid.samples" says; of 32 without it.
denoise::HostFrame frameOf(const image::LayeredImage& file, const std::filesystem::path& name, bool sequence,
                           std::vector<const LayerInfo*>& lacking);

/// Throws InputError listing the layers of variance (LayerInfo::varianceInFiles) that the file lacks:
/// networks need them.
void requireVariances(const image::LayeredImage& file, const std::filesystem::path& name);

}  // namespace limpid
