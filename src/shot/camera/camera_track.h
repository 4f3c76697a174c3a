// The cameras of a shot, from a file beside its frames.
#pragma once

#include <filesystem>
#include <map>
#include <optional>

#include "shaders/common/camera.h"

namespace limpid::shot {

/// A camera whose picture may have any size. Lengths and the angle are at least 0.
struct ShotCamera {
    vec3 eye{0.0f}, forward{0.0f, 0.0f, -1.0f}, up{0.0f, 1.0f, 0.0f};
    float verticalFov = 0.8f;         ///< of a perspective camera, radians
    float orthographicHeight = 0.0f;  ///< of the picture; 0: perspective
    vec2 shift{0.0f, 0.0f};           ///< of the picture, in shares of its larger side; x right, y up

    CameraParams params(uint32_t width, uint32_t height) const;
};

/// The cameras by frame number.
class CameraTrack {
  public:
    /// Reads a JSON file (docs/denoise-your-renders.md, "Cameras"):
    ///
    ///     {"frames": {"1": {"eye": [x, y, z], "forward": [x, y, z], "up": [x, y, z], "fov_y": degrees,
    ///                       "orthographic_height": null, "shift": [0, 0]}, ...}}
    ///
    /// A camera with the key "all" holds for all frames. Throws InputError that says what is wrong where.
    static CameraTrack read(const std::filesystem::path& file);

    /// None if the file has no camera for this frame.
    std::optional<ShotCamera> at(int frame) const;

  private:
    std::map<int, ShotCamera> frames_;
    std::optional<ShotCamera> all_;
};

}  // namespace limpid::shot
