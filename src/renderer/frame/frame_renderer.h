// Frames one after the other, by a pipeline that keeps something from frame to frame: histories of a
// denoiser, or a mean that goes on as long as nothing changes.
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
    /// `samples` per pixel and frame, at least 1. The scene must outlive this.
    FrameRenderer(gpu::Device& device, scene::GpuScene& scene, const RenderSettings& settings,
                  uint32_t samples);

    /// Renders the next frame; `moment` says what it shows. Pipelines that denoise keep their histories
    /// whatever moves; the others start anew when camera, scene, size or settings change. Does not wait for
    /// the device.
    void render(Moment moment);
    /// For the frames to come. Histories go on unless the samples they are made of are of another kind: then
    /// it returns true.
    bool setSettings(const RenderSettings& settings);

    /// Records what is shown of a frame, after its passes; the picture is displayed() from then on.
    using Display = std::function<gpu::ImageHandle(gpu::FrameGraph&, const FrameImages&)>;
    void setDisplay(Display display) { display_ = std::move(display); }
    gpu::ImageHandle displayed() const { return displayed_; }
    gpu::FrameGraph& graph() { return graph_; }
    /// Per pixel, in the mean of pipelines that accumulate.
    uint64_t samplesInMean() const { return samplesInMean_; }

    /// Other than the device's own, for measurements and tests.
    void setFilterBacking(gpu::Backing backing) { filters_ = backing; }

    /// Of the last frame; without settings.layers only what beauty is made of. Waits for the device.
    RenderedLayers download();
    RenderCounters counters();
    /// Zeros without temporal accumulation.
    denoise::DisocclusionCounts disocclusionCounts();
    std::vector<gpu::PassTime> passTimes() { return graph_.passTimes(device_); }
    /// The same of the denoiser's passes alone; empty where the pipeline has none.
    std::vector<gpu::PassTime> denoisingTimes();
    /// Device memory of the images that the denoiser's passes wrote in the last frame, with its histories.
    uint64_t denoisingBytes() const;
    const gpu::FrameGraph& graph() const { return graph_; }
    /// Of the last frame, as it lies on the device (passes/pathtrace/pathtrace.h); empty where the pipeline
    /// makes none. Waits for the device.
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
    std::optional<AccumulationState> state_;  ///< of the last frame
    uint64_t sceneVersion_ = 0;               ///< counts the frames in which something moved
    uint64_t samplesInMean_ = 0;              ///< of pipelines that accumulate
    FrameImages images_;
    Display display_;
    gpu::ImageHandle displayed_;
    std::vector<uint32_t> ids_;  ///< of the mean's first launch, through the pixels' centres
};

}  // namespace limpid
