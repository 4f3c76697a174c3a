// A camera that moves over time: keyed in a JSON file, or one of the built-in paths. docs/animation.md has
// the format.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene/model/scene.h"

namespace limpid::scene {

/// Where the camera is at a time, and what it looks at.
struct CameraKey {
    double time = 0.0;  ///< seconds
    vec3 eye{0.0f}, target{0.0f, 0.0f, -1.0f}, up{0.0f, 1.0f, 0.0f};
    float verticalFov = 0.8f;  ///< radians
    bool cut = false;  ///< a new shot begins here: nothing is interpolated across, and motion is invalid
};

class CameraPath {
  public:
    /// Through `keys`: at least one, times strictly increasing.
    CameraPath(std::string name, std::vector<CameraKey> keys);

    /// The camera at a time; before the first key and after the last it stands still. Between keys of one
    /// shot all values follow cubic Hermite curves through them with tangents by finite differences, which
    /// are smooth and exact for motion at constant speed.
    Camera at(double time) const;
    /// Whether a new shot began after `before`, up to and including `now`.
    bool cutBetween(double before, double now) const;
    double duration() const { return keys_.back().time; }  ///< seconds

  private:
    std::string name_;
    std::vector<CameraKey> keys_;
};

/// Reads a path. Throws InputError: not JSON, an unknown name, a key without time, eye or target, times that
/// do not increase, an eye on its target, an up vector along the view, a field of view not between 0 and 180
/// degrees.
CameraPath loadCameraPath(const std::filesystem::path& file);

/// "orbit": once around what the camera looks at in 10 s; "dolly": towards it and back in 4 s; "shake": a
/// hand-held camera. They start from `camera` and are sized by the scene, and last `seconds`.
CameraPath builtinCameraPath(std::string_view name, const Scene& scene, const Camera& camera, double seconds);
bool isBuiltinCameraPath(std::string_view name);

}  // namespace limpid::scene
