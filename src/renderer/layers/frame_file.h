// Reads a frame for denoisers from an EXR file with Limpid's layers (docs/layers.md).
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "denoise/api/host_frame.h"
#include "image/image.h"

namespace limpid {

/// Puts the values of a channel of the file at to[0], to[stride] and so on, for each pixel. Several threads
/// call it.
using ChannelReader = std::function<void(const std::string& channel, std::span<float> to, size_t stride)>;

/// Reads the frame in the file, including its variance layers. `sequence`: a previous frame exists. Throws
/// InputError if the camera or layers that denoising needs (base/layers/layer_table.h: Need) are missing, and
/// lists them all. Missing layers that are advised for a sequence are added to `lacking`: without `id`,
/// everything counts as one object; without `prevNormal`, nothing rotates. The number of samples is the
/// attribute "limpid.samples", or 32 without it; the jitter is "limpid.jitter". With a `reader`, the file's
/// channels have names and no values, and it reads them, which saves a copy of all in floats.
denoise::HostFrame frameOf(const image::LayeredImage& file, const std::filesystem::path& name, bool sequence,
                           std::vector<const LayerInfo*>& lacking, const ChannelReader& reader = {});

/// The layers that have a variance (LayerInfo::varianceInFiles) which the file lacks.
std::vector<const LayerInfo*> lackingVariances(const image::LayeredImage& file);

}  // namespace limpid
