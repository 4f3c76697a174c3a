// Cameras of glTF files as a track.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scene/gltf/rig/gltf_camera_rig.h"
#include "shot/camera/camera_track.h"

namespace limpid::shot {
namespace {

namespace gltf = scene::gltf;

/// So long an animation is an error, not a shot.
constexpr double maxFrames = 1e6;

std::string nodeName(const gltf::CameraRig& rig, const scene::Camera& camera) {
    return rig.rig.nodes[static_cast<size_t>(camera.node)].name;
}

/// The camera whose node has this name, else the one that has it itself; the only one without a name.
const scene::Camera& chosen(const gltf::CameraRig& rig, const std::string& name,
                            const std::filesystem::path& file) {
    if (rig.cameras.empty()) throw InputError(file, "has no camera");
    if (name.empty() && rig.cameras.size() == 1) return rig.cameras.front();
    for (const scene::Camera& camera : rig.cameras)
        if (!name.empty() && nodeName(rig, camera) == name) return camera;
    for (const scene::Camera& camera : rig.cameras)
        if (!name.empty() && camera.name == name) return camera;
    std::string names;
    for (const scene::Camera& camera : rig.cameras)
        names += fmt::format("{}'{}'", names.empty() ? "" : ", ", nodeName(rig, camera));
    if (name.empty())
        throw InputError(file, fmt::format("has {} cameras; {}#NAME chooses one: {}", rig.cameras.size(),
                                           file.filename().string(), names));
    throw InputError(file, fmt::format("has no camera '{}'; it has {}", name, names));
}

ShotCamera shotCamera(const scene::Camera& camera) {
    ShotCamera result;
    result.eye = vec3(camera.toWorld[3]);
    result.forward = -vec3(camera.toWorld[2]);
    result.up = vec3(camera.toWorld[1]);
    result.verticalFov = camera.verticalFov;
    result.orthographicHeight = camera.orthographic ? 2.0f * camera.halfHeight : 0.0f;
    return result;
}

}  // namespace

CameraTrack CameraTrack::readGltf(const std::filesystem::path& file, const std::string& name,
                                  const GltfTiming& timing) {
    const gltf::CameraRig rig = gltf::loadCameras(file);
    const gltf::CameraMovement movement(rig, chosen(rig, name, file));
    CameraTrack track;
    track.yIsUp_ = true;
    if (movement.still()) {
        track.all_ = shotCamera(movement.at(0.0));
        return track;
    }
    const auto fps = static_cast<double>(timing.framesPerSecond);
    // Times are floats, so a key may lie slightly off its frame.
    constexpr double slack = 0.01;
    const double first = std::ceil(static_cast<double>(movement.firstKey()) * fps - slack);
    const double last = std::floor(static_cast<double>(movement.lastKey()) * fps + slack);
    if (last - first > maxFrames || std::max(std::abs(first), std::abs(last)) > 1e9)
        throw InputError(file, fmt::format("its animation is too long: {:.0f} frames", last - first));
    for (double frame = first; frame <= std::max(first, last); frame += 1.0)
        track.frames_[static_cast<int>(frame) + timing.firstFrame] = shotCamera(movement.at(frame / fps));
    return track;
}

}  // namespace limpid::shot
