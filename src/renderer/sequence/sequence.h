// A scene over time: the point in time that each frame of a sequence shows.
#pragma once

#include <cstdint>
#include <optional>

#include "gpu/graph/frame_graph.h"
#include "renderer/sequence/moment.h"
#include "renderer/sequence/shutter.h"
#include "scene/framing/camera_path.h"
#include "scene/model/camera.h"
#include "scene/motion/scene_animator.h"

namespace limpid {

struct SequenceTiming {
    double framesPerSecond = 30.0;
    double start = 0.0;  ///< time of frame 0, seconds
    Shutter shutter = {};

    double timeOf(uint64_t frame) const { return start + static_cast<double>(frame) / framesPerSecond; }
};

/// From a frame's time to what a launch of it sees, seconds: `instant` of the open shutter (shutter.h). At a
/// cut of the camera path, the shutter sees the frame's own shot only: instants beyond it are mirrored at the
/// frame's time.
double offsetDuring(const SequenceTiming& timing, const std::optional<scene::CameraPath>& path, double time,
                    double instant);

/// Frames can be requested in any order: each also contains the state of the previous frame.
class Sequence {
  public:
    /// `data` was built from `scene`, which must outlive this. `camera` is a camera of the scene or a free
    /// one; `path` replaces it. Either gets `lens`.
    Sequence(const scene::Scene& scene, const scene::SceneData& data, scene::Camera camera,
             std::optional<scene::CameraPath> path, const SequenceTiming& timing,
             const scene::Lens& lens = {});

    /// The state for a picture of this size. Motion is invalid in frame 0 and at cuts of the camera path.
    Moment moment(uint64_t frame, gpu::Extent extent) const;
    /// Whether pictures have motion blur: momentDuring() then takes the place of moment().
    bool isBlurred() const { return timing_.shutter.isOpen() && (animator_ || path_); }
    /// The state while the shutter is open for a frame, offsetDuring() from its time. Motion is that of one
    /// frame's time.
    Moment momentDuring(uint64_t frame, double instant, gpu::Extent extent) const;
    const std::optional<scene::CameraPath>& path() const { return path_; }
    /// The camera alone, at the frame's time.
    CameraParams camera(uint64_t frame, gpu::Extent extent) const {
        return cameraAt(timing_.timeOf(frame), extent);
    }

  private:
    CameraParams cameraAt(double time, gpu::Extent extent) const;
    bool isCut(double before, double now) const { return path_ && path_->cutBetween(before, now); }
    /// `offset`: from the frame's time, seconds.
    Moment momentAt(uint64_t frame, double offset, gpu::Extent extent) const;

    const scene::Scene& scene_;
    std::optional<scene::SceneAnimator> animator_;
    scene::Camera camera_;
    std::optional<scene::CameraPath> path_;
    SequenceTiming timing_;
    scene::Lens lens_;
};

}  // namespace limpid
