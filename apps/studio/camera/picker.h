// What the camera sees through a pixel.
#pragma once

#include <optional>

#include "gpu/graph/frame_graph.h"
#include "gpu/vulkan/device.h"
#include "scene/device/gpu_scene.h"
#include "scene/motion/scene_animator.h"
#include "shaders/common/camera.h"

namespace limpid::studio {

class Picker {
  public:
    /// Both outlive this.
    Picker(gpu::Device& device, const gpu::ShaderReplacements& shaders) : device_(device) {
        graph_.setReplacements(&shaders);
    }

    /// Where the ray through the pixel's centre meets the scene, world space; none where it meets nothing.
    /// `moved`: applied to the device's scene first; it stays so. Waits for the device.
    std::optional<vec3> pointSeen(scene::GpuScene& scene, const std::optional<scene::SceneFrame>& moved,
                                  const CameraParams& camera, gpu::Extent extent, uint32_t x, uint32_t y);

  private:
    gpu::Device& device_;
    gpu::FrameGraph graph_;
};

}  // namespace limpid::studio
