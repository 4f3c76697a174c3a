// What is on show: a scene, on the device.
#pragma once

#include <optional>

#include "scene/device/gpu_scene.h"
#include "scene/framing/framing.h"
#include "scene/lights/light_control.h"
#include "scene/lights/live_lights.h"
#include "scene/motion/scene_animator.h"
#include "studio/background/scene_loading.h"

namespace limpid::studio {

class Stage {
  public:
    /// Throws as GpuScene does.
    Stage(gpu::Device& device, LoadedScene scene, scene::Tracer tracer);
    Stage(const Stage&) = delete;  // the animator refers to the scene
    Stage& operator=(const Stage&) = delete;

    /// The lights as they were loaded.
    const std::vector<scene::LightControl>& originalLights() const { return originalLights_; }
    /// Changes them, for the next frame; as many, in that order.
    void setLights(const std::vector<scene::LightControl>& lights);
    /// setLights() was called since the last frame.
    bool lightsChanged() const { return lightsChanged_; }
    /// The last frame was not rendered: the next one changes the lights that it would have.
    void repeatLights() { lightsChanged_ = lightsChanged_ || lightsSent_; }

    const scene::Scene& scene() const { return scene_; }
    scene::GpuScene& onDevice() { return *onDevice_; }
    const scene::BoundingSphere& sphere() const { return sphere_; }
    /// Seconds of the clip; 0 if none plays.
    double duration() const;
    bool moves() const { return animator_.has_value(); }
    /// From one moment to another.
    struct Step {
        double from, to;
    };
    /// What is to be changed on the device before the next frame. `step`: what the clip does; none: it rests
    /// at `time`.
    std::optional<scene::SceneFrame> nextFrame(const std::optional<Step>& step, double time);
    /// What moves the device's scene to this moment, between frames. Empty if nothing moves.
    std::optional<scene::SceneFrame> standAt(double time) const;

  private:
    /// Without lights.
    scene::SceneFrame frameOf(const Step& step) const;

    scene::Scene scene_;
    std::vector<scene::LightControl> originalLights_, lights_;
    std::optional<scene::LiveLights> live_;
    bool lightsChanged_ = false, lightsSent_ = false;
    scene::BoundingSphere sphere_;
    std::optional<scene::GpuScene> onDevice_;
    std::optional<scene::SceneAnimator> animator_;
};

}  // namespace limpid::studio
