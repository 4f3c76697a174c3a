// The cameras of a shot, from a file beside its frames.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "shaders/common/camera.h"

namespace limpid::shot {

/// A camera whose picture may have any size. Lengths and the angle are at least 0.
struct ShotCamera {
    vec3 eye{0.0f}, forward{0.0f, 0.0f, -1.0f}, up{0.0f, 1.0f, 0.0f};
    float verticalFov = 0.8f;         ///< of a perspective camera, radians
    float orthographicHeight = 0.0f;  ///< of the picture; 0: perspective
    vec2 shift{0.0f, 0.0f};           ///< of the picture, in shares of its larger side; x right, y up

    /// Of a picture with this many pixels. `pixelAspect`: a pixel's width over its height.
    CameraParams params(uint32_t width, uint32_t height, float pixelAspect = 1.0f) const;
};

/// Which axis points up in a world. Both are right-handed, with the same x.
enum class UpAxis { Y, Z };

/// Which frames the moments of a glTF animation are.
struct GltfTiming {
    float framesPerSecond = 24.0f;  ///< above 0
    int firstFrame = 0;             ///< at time 0; Blender exports frame n to n / framesPerSecond
};

/// The cameras by frame number.
class CameraTrack {
  public:
    /// Reads a JSON file (docs/denoise-your-renders.md, "Cameras"), in the space of the file's normals:
    ///
    ///     {"frames": {"1": {"eye": [x, y, z], "forward": [x, y, z], "up": [x, y, z], "fov_y": degrees,
    ///                       "orthographic_height": null, "shift": [0, 0]}, ...}}
    ///
    /// A camera with the key "all" holds for all frames. Or a camera of a glTF file (.gltf, .glb), which has
    /// y up; "FILE#NAME" chooses one of several by its node's name, or its own. Throws InputError that says
    /// what is wrong where.
    static CameraTrack read(const std::string& source, const GltfTiming& timing = {});

    /// In the space of layers with this axis up. None if the file has no camera for this frame. Before and
    /// after a glTF animation, the camera stands still.
    std::optional<ShotCamera> at(int frame, UpAxis up = UpAxis::Y) const;

    /// Those frames that are not in the file: JSON has no camera for them, or the animation of a glTF file
    /// has not begun or is over.
    std::vector<int> lacking(std::span<const int> frames) const;

    /// Of a glTF file.
    bool ofAnimation() const { return yIsUp_; }

    /// Changes with any camera.
    uint64_t hash() const;

  private:
    static CameraTrack readJson(const std::filesystem::path& file);
    static CameraTrack readGltf(const std::filesystem::path& file, const std::string& name,
                                const GltfTiming& timing);

    std::map<int, ShotCamera> frames_;
    std::optional<ShotCamera> all_;
    bool yIsUp_ = false;  ///< of glTF: else the cameras are in the layers' space
};

}  // namespace limpid::shot
