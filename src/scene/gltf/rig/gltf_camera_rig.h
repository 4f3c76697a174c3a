// The cameras of a glTF file and what moves them, without meshes and textures.
#pragma once

#include <filesystem>
#include <vector>

#include "scene/model/scene.h"

namespace limpid::scene::gltf {

/// Cameras at rest; each one's `node` is a node of the rig.
struct CameraRig {
    std::vector<Camera> cameras;
    Rig rig;  ///< nodes and clips; no skins
};

/// Reads the cameras of the default scene, which may be empty. Throws InputError with the file and the fault
/// as load() does, but does not look at what cameras do not need.
CameraRig loadCameras(const std::filesystem::path& file);

/// Places a camera at a time, in seconds: all clips play together, as exporters write one for each object.
/// Only the camera's node and those above it are evaluated.
class CameraMovement {
  public:
    CameraMovement(const CameraRig& all, const Camera& camera);

    Camera at(double time) const;
    /// No clip moves it.
    bool still() const { return clip_.channels.empty(); }
    float firstKey() const;  ///< seconds; of a camera that is not still
    float lastKey() const { return clip_.duration(); }

  private:
    Camera camera_;
    Rig chain_;  ///< the nodes above the camera, and last its own
    Clip clip_;
};

}  // namespace limpid::scene::gltf
