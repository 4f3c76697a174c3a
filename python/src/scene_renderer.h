// A scene on a device, rendered frame by frame.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gpu/vulkan/device.h"
#include "image/image.h"
#include "renderer/frame/frame_renderer.h"
#include "renderer/frame/sequence.h"
#include "scene/device/gpu_scene.h"

namespace limpid::python {

/// limpid/_rendering.py, render(), says what these are. Empty: not given.
struct RenderOptions {
    std::string scene;
    uint32_t width = 0, height = 0;
    uint32_t samples = 1;  ///< per pixel and frame
    uint32_t seed = 0;
    std::string denoiser;
    std::vector<std::string> assignments;  ///< as --set takes them
    std::string environment, camera;
    std::vector<float> eye, target;
    float fov = 0.0f;  ///< degrees
    std::string jitter, weights, assetRoot;
    SequenceTiming timing;
    uint64_t frames = 1;    ///< that a built-in camera path is made for
    std::string animation;  ///< empty: the first clip, if there is one
    std::string cameraPath;
};

/// Shared by all renderers on it, so that they share pipelines; they take turns.
struct RenderDevice {
    explicit RenderDevice(const std::string& select);

    gpu::Device device;
    std::mutex mutex;
};

class SceneRenderer {
  public:
    /// Loads and uploads the scene.
    SceneRenderer(std::shared_ptr<RenderDevice> device, const RenderOptions& options);
    ~SceneRenderer();

    /// All layers that there are, and the camera. With a denoiser, frames come in their order.
    std::pair<image::LayeredImage, CameraParams> render(uint64_t frame);

  private:
    RenderedLayers renderLayers(Moment moment);

    std::shared_ptr<RenderDevice> device_;
    uint32_t samples_;
    RenderSettings settings_;
    scene::Scene scene_;
    std::optional<scene::GpuScene> gpuScene_;
    std::optional<Sequence> sequence_;
    std::optional<FrameRenderer> denoised_;
    std::optional<ProgressiveStill> accumulated_;
};

}  // namespace limpid::python
