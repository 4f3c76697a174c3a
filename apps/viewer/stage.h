// What is on show: a scene, on the device.
#pragma once

#include <optional>

#include "scene/framing.h"
#include "scene/gpu_scene.h"
#include "scene/scene_animator.h"

namespace limpid::viewer {

class Stage {
  public:
    /// `scene` is complete (scene/prepare.h), with its clip chosen if one shall play. Throws as GpuScene
    /// does.
    Stage(gpu::Device& device, scene::Scene scene, scene::Tracer tracer);
    Stage(const Stage&) = delete;  // the animator refers to the scene
    Stage& operator=(const Stage&) = delete;

    const scene::Scene& scene() const { return scene_; }
    scene::GpuScene& onDevice() { return *onDevice_; }
    const scene::BoundingSphere& sphere() const { return sphere_; }
    /// Seconds of the clip; 0 if none plays.
    double duration() const;
    bool moves() const { return animator_.has_value(); }
    /// What moved, for the next frame. Only if it moves.
    scene::SceneFrame frame(double time, double previousTime) const {
        return animator_->frame(time, previousTime);
    }

  private:
    scene::Scene scene_;
    scene::BoundingSphere sphere_;
    std::optional<scene::GpuScene> onDevice_;
    std::optional<scene::SceneAnimator> animator_;
};

}  // namespace limpid::viewer
