#include "studio/live/playback.h"

namespace limpid::studio {
namespace {

constexpr size_t maxCameras = 36000;  // twenty minutes at 30 frames a second

bool samePlace(const scene::CameraKey& a, const scene::CameraKey& b) {
    return a.eye == b.eye && a.target == b.target && a.up == b.up && a.verticalFov == b.verticalFov;
}

}  // namespace

void Playback::reset(double time) {
    start_ = time_ = time;
    frames_ = 0;
    shown_.reset();
    shownBefore_.reset();
    previous_.reset();
    cameras_.clear();
    stoodStill_ = playedAll_ = sameSettings_ = true;
}

void Playback::seek(double time) {
    time_ = time;
    playedAll_ = false;
    shown_.reset();
    shownBefore_.reset();
    previous_.reset();
}

std::optional<Playback::Change> Playback::change() const {
    if (!shown_) return Change{time_, time_};
    // What moved in the last frame needs one more update that sets its motion to zero.
    if (*shown_ == time_ && shownBefore_ && *shownBefore_ == *shown_) return std::nullopt;
    return Change{*shown_, time_};
}

Moment Playback::moment(const CameraParams& now) const {
    return {.camera = now, .previousCamera = previous_, .scene = {}, .number = frames_};
}

void Playback::advance(const CameraParams& params, const scene::CameraKey& camera) {
    if (frames_ > 0 && !wentOn_) playedAll_ = false;
    if (frames_ > 0 && !samePlace(lastCamera_, camera)) stoodStill_ = false;
    lastCamera_ = camera;
    if (cameras_.size() == frames_ && frames_ < maxCameras) {
        cameras_.push_back(camera);
        cameras_.back().time = start_ + static_cast<double>(frames_) / framesPerSecond;
    } else {
        cameras_.clear();
    }
    previous_ = params;
    // The first of two frames at one time has no earlier time to differ from.
    shownBefore_ = shown_ ? shown_ : time_;
    shown_ = time_;
    ++frames_;
    wentOn_ = playing;
    if (!playing) return;
    // Same as SequenceTiming::timeOf(), bit for bit, if possible.
    time_ =
        playedAll_ ? start_ + static_cast<double>(frames_) / framesPerSecond : time_ + 1.0 / framesPerSecond;
}

}  // namespace limpid::studio
