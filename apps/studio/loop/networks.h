// Networks that denoisers of the window need, as far as they are on the device.
#pragma once

#include <filesystem>

#include "gpu/vulkan/device.h"
#include "renderer/frame/settings.h"

namespace limpid::studio {

class Networks {
  public:
    /// `weights`: empty: those that come with Limpid. The device outlives this.
    Networks(gpu::Device& device, std::filesystem::path weights)
        : device_(device), weights_(std::move(weights)) {}

    /// Whether the pipeline needs one that is not there in the precision of `settings`.
    bool lacks(const Pipeline& pipeline, const denoise::DenoiserSettings& settings) const;
    /// Of a pipeline that lacks one. Throws InputError as renderer/frame/network_file.h does; then what was
    /// there stays, and stands for that precision.
    void load(const Pipeline& pipeline, const denoise::DenoiserSettings& settings);
    /// Sets the network that the settings' pipeline needs, or none: settings of the others do not depend on
    /// it.
    void set(RenderSettings& settings) const;

  private:
    gpu::Device& device_;
    std::filesystem::path weights_;
    denoise::KpcnSettings loadedFor_;
    denoise::DenoiserNetworks networks_;
};

}  // namespace limpid::studio
