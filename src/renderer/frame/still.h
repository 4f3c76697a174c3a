// A progressive still: frames are launched until the mean has the requested number of samples. After that the
// device is idle.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gpu/graph/frame_graph.h"
#include "gpu/vulkan/device.h"
#include "renderer/frame/frame.h"
#include "renderer/frame/reset_rule.h"
#include "renderer/layers/layers.h"

namespace limpid {

struct RenderCounters {
    uint64_t rays = 0;      ///< closest-hit and shadow rays
    uint64_t rejected = 0;  ///< samples dropped because they were NaN or infinite
};

/// The sum over the pixels of the image `counters`: rays | rejected, as downloaded.
RenderCounters sumCounters(std::span<const uint32_t> pixels);

/// A frame of a sequence.
struct Moment {
    CameraParams camera;
    std::optional<CameraParams> previousCamera;  ///< empty: the first frame, or a cut; all motion is invalid
    std::optional<scene::SceneFrame> scene;      ///< empty: nothing moves but the camera
    uint64_t number = 0;                         ///< of the frame; selects the random numbers
};

/// The effective settings.samplesPerLaunch: CPUs have a limit, and some integrators take one sample only.
uint32_t samplesPerLaunch(const gpu::Device& device, const RenderSettings& settings);

/// For --dump: the images, by name, that the named pass wrote in the graph's last frame, and the history
/// images that it read. Throws UsageError with the list of passes if there is no such pass.
std::vector<std::pair<std::string, image::Image>> imagesOfPass(gpu::FrameGraph& graph, gpu::Device& device,
                                                               const std::string& pass);

/// Downloads a graph's last frame without its empty images. `samples`: samples per pixel in the means. Waits
/// for the device.
RenderedLayers downloadLayers(gpu::FrameGraph& graph, gpu::Device& device, const FrameImages& images,
                              uint64_t samples);

class ProgressiveStill {
  public:
    /// `maxSamples`: per pixel. The scene must outlive this.
    ProgressiveStill(gpu::Device& device, scene::GpuScene& scene, uint64_t maxSamples);

    /// Sets camera and settings; resets the mean if the reset rule requires it.
    void update(const CameraParams& camera, const RenderSettings& settings, uint64_t sceneVersion = 0);
    /// Goes to a frame of a sequence and starts a new mean.
    void update(Moment moment, const RenderSettings& settings);
    /// Launches one frame, or does nothing and returns false if the maximum is reached. Does not wait for the
    /// device.
    bool launch();
    void finish() { device_.waitIdle(); }

    uint64_t samples() const { return samples_; }
    uint32_t frames() const { return frame_; }

    /// The means so far, as host images. Waits for the device. Throws Error before the first launch.
    RenderedLayers download();
    RenderCounters counters();
    std::vector<gpu::PassTime> passTimes() { return graph_.passTimes(device_); }

  private:
    uint64_t launchesOfAFrame() const;

    gpu::Device& device_;
    scene::GpuScene& scene_;
    uint64_t maxSamples_;
    gpu::FrameGraph graph_;
    AccumulationState state_;
    std::optional<CameraParams> previousCamera_;
    std::optional<scene::SceneFrame> moved_;  ///< since the last launch
    uint64_t number_ = 0;                     ///< number of the sequence's frame
    FrameImages images_;
    std::vector<uint32_t> ids_;  ///< ids of frame 0, whose first sample goes through the pixel's centre
    uint64_t samples_ = 0;
    uint32_t frame_ = 0;
};

}  // namespace limpid
