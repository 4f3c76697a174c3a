// Computes the device data of a frame from a clip and two times.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "scene/device/scene_data.h"
#include "scene/model/scene.h"

namespace limpid::scene {

/// One frame of a moving scene: the changes to the buffers of GpuScene. Does not depend on earlier frames,
/// since it includes the state of the previous frame.
struct SceneFrame {
    struct Upload {
        std::string_view buffer;  ///< name in scene_data.glsl
        uint64_t offset = 0;      ///< bytes
        std::vector<std::byte> bytes;
    };
    std::vector<Upload> uploads;
    std::vector<std::pair<uint32_t, gpu::TreePlacement>> placements;  ///< indices into SceneData's placements
    std::vector<layout::PoseParams> poses;                            ///< one per deforming instance
    std::span<const RefitLevel> refitLevels;                          ///< of the animator
    uint32_t firstRefitNode = 0;
    std::vector<NodeRange> changedNodes;  ///< by uploads and refitting
    layout::SceneParams params{};
};

class SceneAnimator {
  public:
    /// `scene` must have a clip chosen (scene/motion/movement.h), `data` must be built from it, and it must
    /// outlive this object.
    SceneAnimator(const Scene& scene, const SceneData& data);

    /// Returns the scene at `time`, in seconds, with motion relative to `previousTime`. The cost depends on
    /// the moving parts, not on the size of the scene. Throws Error if a vertex position would overflow.
    SceneFrame frame(double time, double previousTime) const;

    /// Call it when the lights were packed again (scene/lights/live_lights.h), with the same number and
    /// order.
    void setLights(const SceneData& data);

  private:
    struct Moment;
    Moment momentAt(double time) const;
    Aabb boundsOf(const DeformingInstance& deforming, const Moment& moment) const;
    void addPoses(const Moment& now, const Moment& before, SceneFrame& frame) const;
    void addInstances(const Moment& now, const Moment& before, SceneFrame& frame) const;
    void addMovingTree(const Moment& now, SceneFrame& frame) const;
    /// These two also move the lights in `tree`, unless it is empty.
    void addTriangleLights(const Moment& now, SceneFrame& frame, LightTree& tree) const;
    void addPunctualLights(const Moment& now, SceneFrame& frame, LightTree& tree) const;
    static void addLightTree(LightTree& tree, SceneFrame& frame);
    /// An instance's vertices in its own coordinates, and where these are.
    struct Placed {
        std::vector<vec3> positions;
        mat4 toWorld;
    };
    Placed placed(uint32_t instance, const Moment& moment) const;

    const Scene& scene_;
    MotionData motion_;
    layout::SceneParams params_;
    bool hasVertexData_;
    std::vector<uvec4>
        records_;  ///< the last texel of every moving instance's record in `instances`, by leaf
    std::vector<uint32_t> firstTriangles_;  ///< of the trees
    /// Of motion_.lights as packed, LIGHT_TEXELS for each triangle.
    std::vector<std::vector<uvec4>> lightRecords_;
    std::vector<uvec4> punctual_;  ///< the scene's punctual lights as packed
    uint64_t firstPunctual_ = 0;   ///< first texel of these in `lights`
};

/// Returns the camera at the position of its node at `time`.
Camera cameraAt(const Scene& scene, const Camera& camera, double time);

}  // namespace limpid::scene
