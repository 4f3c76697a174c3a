// Renders successive frames by a pipeline that keeps state between frames: the histories of a denoiser, or a
// mean that continues until something changes.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "gpu/vulkan/device.h"
#include "renderer/frame/frame.h"
#include "renderer/frame/reset_rule.h"
#include "renderer/frame/still.h"
#include "renderer/layers/layers.h"

namespace limpid {

class FrameRenderer {
  public:
    /// `samples`: per pixel and frame, at least 1. The scene must outlive this.
    FrameRenderer(gpu::Device& device, scene::GpuScene& scene, const RenderSettings& settings,
                  uint32_t samples);

    /// Renders the next frame, which shows `moment`. Denoising pipelines keep their histories when anything
    /// moves. The others restart when camera, scene, size or settings change. Does not wait for the device.
    void render(Moment moment);
    /// Sets the settings of the following frames. Histories continue, unless their samples are of another
    /// kind than the new ones; in that case they restart and this returns true.
    bool setSettings(const RenderSettings& settings);

    /// Records passes after those of the frame that make the displayed picture; displayed() returns it.
    using Display = std::function<gpu::ImageHandle(gpu::FrameGraph&, const FrameImages&)>;
    void setDisplay(Display display) { display_ = std::move(display); }
    gpu::ImageHandle displayed() const { return displayed_; }
    gpu::FrameGraph& graph() { return graph_; }
    /// Samples per pixel in the mean, for pipelines that accumulate.
    uint64_t samplesInMean() const { return samplesInMean_; }

    /// Overrides the device's default, for measurements and tests.
    void setFilterBacking(gpu::Backing backing) { filters_ = backing; }

    /// Downloads the last frame; without settings.layers only the layers that make up beauty. Waits for the
    /// device.
    RenderedLayers download();
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
    void launch(FrameInput input);
    void launchAccumulated(const FrameInput& input);

    gpu::Device& device_;
    scene::GpuScene& scene_;
    RenderSettings settings_;
    uint32_t samples_;
    gpu::Backing filters_;
    gpu::FrameGraph graph_;
    std::optional<AccumulationState> state_;  ///< state of the last frame
    uint64_t sceneVersion_ = 0;               ///< counts the frames in which something moved
    uint64_t samplesInMean_ = 0;              ///< for pipelines that accumulate
    FrameImages images_;
    Display display_;
    gpu::ImageHandle displayed_;
    std::vector<uint32_t> ids_;  ///< ids of the mean's first launch, through the pixels' centres
};

}  // namespace limpid
