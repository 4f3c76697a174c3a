// Weights of neural denoisers: finds the file and loads it onto the device.
#pragma once

#include <filesystem>

#include "base/progress.h"
#include "denoise/api/denoiser.h"
#include "gpu/vulkan/device.h"

namespace limpid {

/// Minimum samples per pixel of a frame for a network; fewer contain too little information.
constexpr uint32_t minNetworkSamples = 8;

/// Weights that come with Limpid: kpcn.safetensors, or kpcn-cis565.safetensors if `settings.cis565`. They are
/// looked for in the folder of the library that this is part of and in two above it, and in share/limpid
/// there and in five above it; then likewise from the program's folder. Empty if there is no such file.
std::filesystem::path shippedWeights(const denoise::KpcnSettings& settings);

/// Loads the network that the denoiser needs (null: none) from `file`, or from the shipped file if `file` is
/// empty. Throws InputError like denoise::readKpcnWeights(), and if there is no such file; UsageError if a
/// file is named for a denoiser without a network; Cancelled. May run beside frames of the device on another
/// thread.
denoise::DenoiserNetworks loadNetworks(gpu::Device& device, const denoise::Denoiser* denoiser,
                                       const std::filesystem::path& file,
                                       const denoise::DenoiserSettings& settings,
                                       const Progress& progress = {});

}  // namespace limpid
