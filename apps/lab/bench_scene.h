// A scene under a moving camera, for measuring what its frames' passes cost.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "gpu/vulkan/device.h"
#include "renderer/method/settings.h"
#include "scene/device/gpu_scene.h"
#include "scene/load/scene_source.h"
#include "scene/model/scene.h"

namespace limpid::cli {

struct PassCost {
    std::vector<double> milliseconds;  ///< by frame
    uint64_t bytes = 0;                ///< of the images that a frame's pass reads or writes
};

class BenchScene {
  public:
    /// `cameraPath`: a built-in one or a file. Throws as loading a scene does. The device must outlive it.
    BenchScene(gpu::Device& device, scene::Tracer tracer, const scene::SceneSource& source,
               std::string cameraPath = "shake");

    uint64_t triangleCount() const { return scene_.triangleCount(); }

    /// Every pass of `frames` frames of one sample under the moving camera, after `warmup` others.
    /// `filters`: empty for what the device likes.
    std::map<std::string, PassCost> measure(const RenderSettings& settings, uint32_t warmup, uint32_t frames,
                                            std::optional<gpu::Backing> filters = {});

  private:
    gpu::Device& device_;
    std::string cameraPath_;
    scene::Scene scene_;
    scene::SceneData data_;
    scene::GpuScene gpuScene_;
};

}  // namespace limpid::cli
