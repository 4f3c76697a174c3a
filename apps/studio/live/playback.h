// Time in the window: frames since the last reset, the moment that each shows, and what the camera did.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/sequence/moment.h"
#include "scene/framing/camera_path.h"

namespace limpid::studio {

/// Goes from frame to frame, not by the clock: each frame of a clip that plays is 1 / framesPerSecond later
/// than the one before, as in `limpid render --frames`.
class Playback {
  public:
    double framesPerSecond = 30.0;
    bool playing = false;

    /// Of the next frame, seconds.
    double time() const { return time_; }
    /// Frames since the last reset.
    uint64_t frames() const { return frames_; }
    /// The next frame is the first one again, at this time; nothing is known of frames before it.
    void reset(double time);
    /// Goes to another moment, as a cut.
    void seek(double time);

    /// What of the scene differs from the last frame's, for the next one: from when to when. None: nothing,
    /// and the device's scene stands at the right moment already.
    struct Change {
        double from, to;
    };
    std::optional<Change> change() const;
    /// Of the next frame, without the scene.
    Moment moment(const CameraParams& now) const;
    /// The next frame was rendered so.
    void advance(const CameraParams& params, const scene::CameraKey& camera);

    /// The camera of all frames since the reset; key n has the time of frame n. Empty if there were too many.
    const std::vector<scene::CameraKey>& cameras() const { return cameras_; }
    /// Of the last frame.
    const scene::CameraKey& lastCamera() const { return lastCamera_; }
    /// From the next frame on, settings are others than those of the frames since the reset.
    void noteOtherSettings() { sameSettings_ = sameSettings_ && frames_ == 0; }
    bool sameSettings() const { return sameSettings_; }
    bool cameraStoodStill() const { return stoodStill_; }
    /// Time went on in every frame since the reset.
    bool playedThroughout() const { return playedAll_; }
    double startTime() const { return start_; }
    /// Of the last frame.
    double shownTime() const { return shown_.value_or(time_); }

  private:
    double start_ = 0.0, time_ = 0.0;
    uint64_t frames_ = 0;
    std::optional<double> shown_, shownBefore_;  ///< times of the last frame and of the one before it
    std::optional<CameraParams> previous_;
    std::vector<scene::CameraKey> cameras_;
    scene::CameraKey lastCamera_;
    bool stoodStill_ = true, playedAll_ = true, wentOn_ = false, sameSettings_ = true;
};

}  // namespace limpid::studio
