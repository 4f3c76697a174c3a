// Renders the frames of stills and sequences, launch by launch: the running means of samples, or successive
// frames of a denoiser, which keeps histories.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gpu/vulkan/device.h"
#include "gpu/vulkan/image_readback.h"
#include "renderer/frame/frame.h"
#include "renderer/frame/frame_download.h"
#include "renderer/frame/history_reasons.h"
#include "renderer/frame/reset_rule.h"
#include "renderer/layers/layers.h"
#include "renderer/sequence/moment.h"

namespace limpid {

/// The effective settings.samplesPerLaunch: CPUs and Sobol' points have limits, and some integrators take one
/// sample only.
uint32_t samplesPerLaunch(const gpu::Device& device, const RenderSettings& settings);

/// The samples per pixel that one launch takes.
struct LaunchSamples {
    uint64_t stream = 0;  ///< FrameInput::stream
    uint64_t first = 0;   ///< number of the first one, since the last reset
    uint64_t point = 0;   ///< the same over all frames: CameraLaunch::firstPoint
    uint32_t count = 1;
    bool alone = false;  ///< the frame has no others
};

class FrameRenderer {
  public:
    /// `samples`: per pixel and frame, at least 1. The scene must outlive this.
    FrameRenderer(gpu::Device& device, scene::GpuScene& scene, const RenderSettings& settings,
                  uint64_t samples);

    /// Renders the next frame, which shows `moment`. Denoising pipelines keep their histories when anything
    /// moves. The others continue the mean until camera, scene, size or settings change. Does not wait for
    /// the device.
    void render(Moment moment);

    /// Goes to a frame that continues nothing: its mean and its histories are new. Launches render it.
    void begin(Moment moment);
    /// Shows another moment from the next launch on, while the frame's mean goes on: motion blur.
    void moveOn(Moment moment) { goTo(std::move(moment)); }
    /// Records the first launch of a frame that continues nothing, without executing it: graph() then tells
    /// which pipelines it needs, and can compile them.
    void plan(Moment moment);
    /// Launches the next samples of the frame; a denoising pipeline takes all of them at once. Returns false
    /// if there are none left. Does not wait for the device.
    bool launch();
    /// Launches these samples of the frame instead, for callers with a plan of their own.
    void launch(const LaunchSamples& taken);
    /// Makes the next launch the first one of a new mean or of new histories.
    void restart();

    /// Sets the settings of the following frames. Histories continue, unless their samples are of another
    /// kind than the new ones; in that case they restart and this returns true.
    bool setSettings(const RenderSettings& settings);
    const RenderSettings& settings() const { return settings_; }

    /// Records passes after those of the frame that make the displayed picture; displayed() returns it.
    using Display = std::function<gpu::ImageHandle(gpu::FrameGraph&, const FrameImages&)>;
    void setDisplay(Display display) { display_ = std::move(display); }
    gpu::ImageHandle displayed() const { return displayed_; }
    gpu::FrameGraph& graph() { return graph_; }
    /// Samples per pixel in the mean, for pipelines that accumulate.
    uint64_t samplesInMean() const { return samplesInMean_; }

    /// Overrides the device's default, for measurements and tests.
    void setFilterBacking(gpu::Backing backing) { filters_.backing = backing; }

    /// For debugging: whether the following frames also tell why the denoiser kept or rejected histories.
    void setReasons(bool wanted) { reasons_ = wanted; }
    /// Those of the last frame. Waits for the device.
    HistoryReasons historyReasons();

    /// Downloads the last frame; without settings.layers only the layers that make up beauty. Waits for the
    /// device. Throws Error before the frame's first launch.
    RenderedLayers download();
    /// Downloads a layer of floats that the last launch has computed. Waits for the device.
    std::vector<float> download(const LayerInfo& layer) {
        return graph_.downloadFloat(device_, images_[layer]);
    }
    /// Ids that belong to the mean: those through the pixels' centres. Waits for the launch that found them.
    const std::vector<uint32_t>& ids();
    bool hasLaunched() const { return !graph_.passes().empty(); }
    RenderCounters counters();
    /// All zero without temporal accumulation.
    denoise::DisocclusionCounts disocclusionCounts();
    std::vector<gpu::PassTime> passTimes() { return graph_.passTimes(device_); }
    /// Like passTimes(), but only for the denoiser's passes; empty if the pipeline has no denoiser.
    std::vector<gpu::PassTime> denoisingTimes();
    /// Device memory of the images that the denoiser's passes wrote in the last frame, including histories.
    uint64_t denoisingBytes() const;
    const gpu::FrameGraph& graph() const { return graph_; }
    /// Motion of the last frame in the device's format (passes/pathtrace/pathtrace.h); empty if the pipeline
    /// computes none. Waits for the device.
    image::Image motion();
    std::vector<std::pair<std::string, image::Image>> dump(const std::string& pass) {
        return imagesOfPass(graph_, device_, pass);
    }

  private:
    void goTo(Moment moment);
    LaunchSamples nextSamples() const;
    void record(const LaunchSamples& taken);
    /// Throws UsageError if the recorded frame has a buffer that the device cannot have.
    void checkBuffers() const;
    void readIds();

    gpu::Device& device_;
    scene::GpuScene& scene_;
    RenderSettings settings_;
    uint64_t samples_;
    gpu::FilterChoice filters_;
    bool reasons_ = false;
    gpu::FrameGraph graph_;
    Moment moment_;
    AccumulationState state_;       ///< state of the frame
    uint64_t sceneVersion_ = 0;     ///< counts the frames in which something moved
    uint64_t launches_ = 0;         ///< of the frame, so far
    uint64_t samplesLaunched_ = 0;  ///< of the frame, so far
    uint64_t samplesInMean_ = 0;    ///< for pipelines that accumulate
    uint64_t firstPoint_ = 0;       ///< added to sample numbers where they choose points of the pixel
    FrameImages images_;
    Display display_;
    gpu::ImageHandle displayed_;
    std::optional<gpu::ImageReadback> idsReadback_;
    bool idsUnderWay_ = false;
    std::vector<uint32_t> ids_;
};

}  // namespace limpid
