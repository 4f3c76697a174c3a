// A scene on a device, rendered frame by frame.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gpu/vulkan/device.h"
#include "image/image.h"
#include "renderer/frame/frame_renderer.h"
#include "renderer/sequence/sequence.h"
#include "scene/device/gpu_scene.h"
#include "scene/load/scene_source.h"

namespace limpid::python {

/// The options of render() in limpid/_rendering.py, which documents them. Empty: not given.
struct RenderOptions {
    scene::SceneSource source;
    uint32_t width = 0, height = 0;
    uint32_t samples = 1;  ///< per pixel and frame
    uint32_t seed = 0;
    std::string denoiser;
    std::vector<std::string> assignments;  ///< each as for --set
    std::string camera;
    std::vector<float> eye, target;
    float fov = 0.0f;  ///< degrees
    std::string jitter, weights;
    SequenceTiming timing;
    uint64_t frames = 1;    ///< length of a built-in camera path
    std::string animation;  ///< empty: the first clip, if there is one
    std::string cameraPath;
};

/// A device shared by all its renderers, so that they share pipelines; they take turns.
struct RenderDevice {
    explicit RenderDevice(const std::string& select);

    gpu::Device device;
    std::mutex mutex;
};

class SceneRenderer {
  public:
    /// Loads the scene and uploads it.
    SceneRenderer(std::shared_ptr<RenderDevice> device, const RenderOptions& options);
    ~SceneRenderer();

    /// Renders a frame and returns all its layers and the camera. With a denoiser, frames must be rendered in
    /// order. `between` is called between launches, and on CPUs within them. What it throws ends the frame;
    /// then only the destructor may be called.
    std::pair<image::LayeredImage, CameraParams> render(uint64_t frame, const std::function<void()>& between);

  private:
    RenderedLayers renderLayers(uint64_t frame, const std::function<void()>& between);
    void renderBlurred(uint64_t frame, const std::function<void()>& between);

    std::shared_ptr<RenderDevice> device_;
    RenderSettings settings_;
    uint32_t samples_;
    scene::Scene scene_;
    std::optional<scene::GpuScene> gpuScene_;
    std::optional<Sequence> sequence_;
    std::optional<FrameRenderer> renderer_;
};

}  // namespace limpid::python
