// A scene over time: which moment each frame of a sequence shows.
#pragma once

#include <cstdint>
#include <optional>

#include "renderer/frame/still.h"
#include "scene/framing/camera_path.h"
#include "scene/motion/scene_animator.h"

namespace limpid {

struct SequenceTiming {
    double framesPerSecond = 30.0;
    double start = 0.0;  ///< seconds, of frame 0

    double timeOf(uint64_t frame) const { return start + static_cast<double>(frame) / framesPerSecond; }
};

/// Every frame can be asked for alone, in any order: it knows the one before it.
class Sequence {
  public:
    /// `scene` is what `data` was built from, and outlives this. `camera` is one of the scene's, or free;
    /// `path` replaces it.
    Sequence(const scene::Scene& scene, const scene::SceneData& data, scene::Camera camera,
             std::optional<scene::CameraPath> path, const SequenceTiming& timing);

    /// For pictures of this size. Motion is invalid in frame 0 and where the camera path cuts.
    Moment moment(uint64_t frame, gpu::Extent extent) const;
    /// The camera alone.
    CameraParams camera(uint64_t frame, gpu::Extent extent) const {
        return cameraAt(timing_.timeOf(frame), extent);
    }

  private:
    CameraParams cameraAt(double time, gpu::Extent extent) const;

    const scene::Scene& scene_;
    std::optional<scene::SceneAnimator> animator_;
    scene::Camera camera_;
    std::optional<scene::CameraPath> path_;
    SequenceTiming timing_;
};

}  // namespace limpid
