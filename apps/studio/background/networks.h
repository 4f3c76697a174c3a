// Networks that denoisers of the window need, as far as they are on the device. They are read on a thread of
// its own, while frames are rendered without them.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "gpu/vulkan/device.h"
#include "renderer/method/settings.h"

namespace limpid::studio {

/// Returns what a denoiser needs: as limpid::loadNetworks(). Runs on another thread than the frames.
using NetworkLoader = std::function<denoise::DenoiserNetworks(
    gpu::Device& device, const denoise::Denoiser* denoiser, const std::filesystem::path& weights,
    const denoise::DenoiserSettings& settings, const Progress& progress)>;

class Networks {
  public:
    /// `weights`: empty: those that come with Limpid. `load`: empty: limpid::loadNetworks(). The device
    /// outlives this.
    Networks(gpu::Device& device, std::filesystem::path weights, NetworkLoader load = {});
    /// Gives up what is being loaded, and waits for its thread.
    ~Networks();
    Networks(const Networks&) = delete;
    Networks& operator=(const Networks&) = delete;

    /// Whether the pipeline needs one that is not there in the precision of `settings`.
    bool lacks(const Pipeline& pipeline, const denoise::DenoiserSettings& settings) const;
    /// Whether frames of the pipeline can be rendered: with the network in another precision, if need be.
    bool canRender(const Pipeline& pipeline) const { return !pipeline.usesNetwork() || networks_.kpcn; }
    /// Begins to load what a pipeline lacks, unless that is being loaded already. What was being loaded for
    /// other settings is given up.
    void begin(const Pipeline& pipeline, const denoise::DenoiserSettings& settings);
    bool isLoading() const { return loading_.valid(); }
    bool isDone() const;
    void wait() const { loading_.wait(); }
    int percent() const { return static_cast<int>(100.0 * progress_.done()); }
    /// Waits for what is being loaded, and keeps it. Throws InputError as renderer/method/network_file.h
    /// does; then what was there stays, and stands for that precision.
    void take();
    /// Gives up what is being loaded; nothing waits for it.
    void cancel();
    /// The same; what was there stays, and stands for that precision.
    void settle();
    /// Sets the network that the settings' pipeline needs, or none: settings of the others do not depend on
    /// it.
    void set(RenderSettings& settings) const;

  private:
    gpu::Device& device_;
    std::filesystem::path weights_;
    NetworkLoader load_;
    denoise::KpcnSettings loadedFor_, loadingFor_;
    denoise::DenoiserNetworks networks_;
    Progress progress_;
    std::future<denoise::DenoiserNetworks> loading_;
    std::vector<std::future<denoise::DenoiserNetworks>> cancelled_;  ///< their threads still run
};

}  // namespace limpid::studio
