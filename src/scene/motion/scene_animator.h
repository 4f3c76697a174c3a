// From a clip and two moments to what the device needs for a frame.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "scene/device/scene_data.h"
#include "scene/model/scene.h"

namespace limpid::scene {

/// One frame of a moving scene: what changes in the buffers of GpuScene. Needs nothing of the frames before
/// it: the previous frame is in it.
struct SceneFrame {
    struct Upload {
        std::string_view buffer;  ///< as in scene_data.glsl
        uint64_t offset = 0;      ///< bytes
        std::vector<std::byte> bytes;
    };
    std::vector<Upload> uploads;
    std::vector<std::pair<uint32_t, gpu::TreePlacement>> placements;  ///< of SceneData, by their numbers
    std::vector<layout::PoseParams> poses;                            ///< one per deforming instance
    std::span<const RefitLevel> refitLevels;                          ///< of the animator
    uint32_t firstRefitNode = 0;
    std::vector<NodeRange> changedNodes;  ///< by uploads and by refitting
    layout::SceneParams params{};
};

class SceneAnimator {
  public:
    /// `scene` has a clip chosen (scene/motion/movement.h), is what `data` was built from, and outlives this.
    SceneAnimator(const Scene& scene, const SceneData& data);

    /// The scene at `time`, seconds; motion is told from `previousTime`. Costs what moves, not what the scene
    /// has. Throws Error if a vertex would leave the range of numbers.
    SceneFrame frame(double time, double previousTime) const;

    /// The lights were packed again (scene/model/live_lights.h), as many and in the same order.
    void setLights(const SceneData& data);

  private:
    struct Moment;
    Moment momentAt(double time) const;
    Aabb boundsOf(const DeformingInstance& deforming, const Moment& moment) const;
    void addPoses(const Moment& now, const Moment& before, SceneFrame& frame) const;
    void addInstances(const Moment& now, const Moment& before, SceneFrame& frame) const;
    void addMovingTree(const Moment& now, SceneFrame& frame) const;
    void addTriangleLights(const Moment& now, SceneFrame& frame) const;
    void addPunctualLights(const Moment& now, SceneFrame& frame) const;
    std::vector<vec3> worldPositions(uint32_t instance, const Moment& moment) const;

    const Scene& scene_;
    MotionData motion_;
    layout::SceneParams params_;
    bool hasVertexData_;
    std::vector<uvec4>
        records_;  ///< the last texel of every moving instance's record in `instances`, by leaf
    std::vector<uint32_t> firstTriangles_;  ///< of the trees
    std::vector<uvec4> punctual_;           ///< the scene's punctual lights as packed
    uint64_t firstPunctual_ = 0;            ///< their first texel in `lights`
};

/// The camera where its node stands at `time`.
Camera cameraAt(const Scene& scene, const Camera& camera, double time);

}  // namespace limpid::scene
