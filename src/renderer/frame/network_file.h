// Weights of denoisers that are networks: which file, and onto the device.
#pragma once

#include <filesystem>

#include "denoise/api/denoiser.h"
#include "gpu/vulkan/device.h"

namespace limpid {

/// Fewer samples per pixel tell a network too little of a frame.
constexpr uint32_t minNetworkSamples = 8;

/// Weights that come with Limpid: kpcn.safetensors, or kpcn-cis565.safetensors if `settings.cis565`, beside
/// the program, or in ../share/limpid seen from there. Empty if there are none.
std::filesystem::path shippedWeights(const denoise::KpcnSettings& settings);

/// What the denoiser (null: none) needs, its weights read from `file`; empty: the shipped ones. Throws
/// InputError as denoise::readKpcnWeights(), and if there is no such file; UsageError if a file is named for
/// a denoiser that is none.
denoise::DenoiserNetworks loadNetworks(gpu::Device& device, const denoise::Denoiser* denoiser,
                                       const std::filesystem::path& file,
                                       const denoise::DenoiserSettings& settings);

}  // namespace limpid
