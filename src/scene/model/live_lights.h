// Lights of a scene that is on the device already, changed there without building the scene again.
#pragma once

#include <string_view>
#include <vector>

#include "scene/motion/scene_animator.h"

namespace limpid::scene {

class LiveLights {
  public:
    /// `data` is what `scene` was built into.
    LiveLights(const Scene& scene, const SceneData& data);

    /// After applyLightControls(): packs the lights again and draws up their probabilities anew.
    void update(const Scene& scene);
    /// Adds all that update() changed to a frame. `frame` may hold what an animator writes for its moment,
    /// which goes over it.
    void addTo(SceneFrame& frame) const;
    /// For every frame: the environment's factor and turn, and how often each kind of light is sampled.
    void setParams(layout::SceneParams& params) const;
    /// The lights as packed: for SceneAnimator::setLights().
    const SceneData& packed() const { return packed_; }

  private:
    SceneData packed_;             ///< instances, lights and their tables alone
    std::vector<int> emitters_;    ///< materials
    std::vector<vec3> emissions_;  ///< theirs
};

}  // namespace limpid::scene
