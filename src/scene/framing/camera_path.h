// A camera that moves over time: keys from a JSON file, or one of the built-in paths. docs/animation.md
// describes the format.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene/model/scene.h"

namespace limpid::scene {

/// The camera's position and target at a time.
struct CameraKey {
    double time = 0.0;  ///< seconds
    vec3 eye{0.0f}, target{0.0f, 0.0f, -1.0f}, up{0.0f, 1.0f, 0.0f};
    float verticalFov = 0.8f;    ///< radians
    float lensDiameter = 0.0f;   ///< world units; 0: a pinhole
    float focusDistance = 0.0f;  ///< world units; 0: that of the target
    bool cut = false;  ///< a new shot begins here: no interpolation across it, and motion is invalid
};

class CameraPath {
  public:
    /// Creates a path through `keys`: at least one, with strictly increasing times.
    CameraPath(std::string name, std::vector<CameraKey> keys);

    /// Returns the camera at a time; it stands still before the first key and after the last. Between keys of
    /// one shot, all values follow cubic Hermite curves with finite-difference tangents, which are smooth,
    /// and exact for motion at constant speed.
    Camera at(double time) const;
    /// Returns the camera of the key with the widest lens.
    Camera widest() const;
    /// True if a new shot began after `before`, up to and including `now`.
    bool cutBetween(double before, double now) const;
    const std::vector<CameraKey>& keys() const { return keys_; }
    double duration() const { return keys_.back().time; }  ///< seconds

  private:
    std::string name_;
    std::vector<CameraKey> keys_;
};

/// Reads a path. Throws InputError if it is not JSON, has an unknown name, a key without time, eye or target,
/// times that do not increase, an eye equal to its target, an up vector parallel to the view, a field of view
/// not between 0 and 180 degrees, or a lens of negative size or without a distance.
CameraPath loadCameraPath(const std::filesystem::path& file);

/// "orbit": once around the camera's target in 10 s; "dolly": towards it and back in 4 s; "shake": a
/// hand-held camera. The paths start from `camera`, are scaled to the scene, and last `seconds`.
CameraPath builtinCameraPath(std::string_view name, const Scene& scene, const Camera& camera, double seconds);
bool isBuiltinCameraPath(std::string_view name);

}  // namespace limpid::scene
