// The camera of the window: one of the scene's, one that moves on a path, or one that a hand moves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/framing/camera_path.h"
#include "studio/camera/fly_camera.h"
#include "studio/live/stage.h"

namespace limpid::studio {

/// As the panel lists them: their own names, with their numbers where two are the same, or numbers alone.
std::vector<std::string> cameraNames(const std::vector<scene::Camera>& cameras);

class CameraRig {
  public:
    /// Another scene; `home` is where a free camera starts.
    void show(const Stage& stage, const scene::Camera& home);

    /// The same scene again, or nearly: what has been chosen stays, as far as it is there.
    void keep(const Stage& stage);
    /// "free", the scene's cameras, the built-in paths: what choose() takes the number of.
    const std::vector<std::string>& names() const { return names_; }
    bool isFree() const { return chosen_ == 0; }
    int chosen() const { return chosen_; }
    /// The free camera is where the hand has left it.
    void choose(const Stage& stage, int number);
    /// From where it is. Nothing if it is free.
    void setFree(const Stage& stage, double time);
    /// Free, from there.
    void stand(const Stage& stage, const scene::Camera& camera);
    /// Free, and where FlyCamera::place() puts it.
    bool place(const Stage& stage, double time, const vec3& eye, const vec3& target, const vec3& up);
    /// Back to where it started.
    void goHome(const Stage& stage);

    scene::Camera at(const Stage& stage, double time) const;
    /// Of the free one.
    scene::CameraKey key() const;
    FlyCamera& hand() { return fly_; }
    const FlyCamera& hand() const { return fly_; }
    const scene::Camera& home() const { return home_; }
    bool movesOnPath() const { return path_.has_value(); }
    const std::optional<scene::CameraPath>& path() const { return path_; }
    /// Of the clip, or at least of the path.
    double duration(const Stage& stage) const;
    /// Options of the command line that choose it; empty if it is free. `start`: those of the first scene's.
    std::string option(const std::string& start) const;

  private:
    void nameAll(const Stage& stage);
    scene::Camera home_;
    FlyCamera fly_{scene::Camera{}, 1.0f};
    std::optional<scene::CameraPath> path_;
    std::vector<std::string> names_;
    int chosen_ = 0;
};

}  // namespace limpid::studio
