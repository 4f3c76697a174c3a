// Updates the lights of a scene on the device without building the scene again.
#pragma once

#include <string_view>
#include <vector>

#include "scene/motion/scene_animator.h"

namespace limpid::scene {

class LiveLights {
  public:
    /// `data` must have been built from `scene`.
    LiveLights(const Scene& scene, const SceneData& data);

    /// Packs the lights and recomputes their probabilities. Call it after applyLightControls().
    void update(const Scene& scene);
    /// Adds all changes of update() to a frame. If `frame` has an animator's values for its time, these take
    /// precedence.
    void addTo(SceneFrame& frame) const;
    /// Sets the environment's factor and rotation, and the sampling probability of each kind of light. Call
    /// it for every frame.
    void setParams(layout::SceneParams& params) const;
    /// The packed lights, for SceneAnimator::setLights().
    const SceneData& packed() const { return packed_; }

  private:
    SceneData packed_;             ///< only instances, lights and their tables
    std::vector<int> emitters_;    ///< indices of materials
    std::vector<vec3> emissions_;  ///< of these materials
};

}  // namespace limpid::scene
