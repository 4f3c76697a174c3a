// What decides a render's pixels, as text: so that samples of different renders are never mixed.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "renderer/frame/sequence.h"

namespace limpid {

/// Of all that the device gets of the scene (trees, materials, textures, lights, environment) and of the
/// animation that moves it. `data` was built from `scene`.
uint64_t sceneHash(const scene::Scene& scene, const scene::SceneData& data);

/// Of the cameras of the frames: of all of them, or of a thousand spread evenly over more.
uint64_t cameraHash(const Sequence& sequence, uint64_t frames, gpu::Extent extent);

struct RenderIdentity {
    std::string version;    ///< of Limpid
    std::string sceneName;  ///< the file's name without folders, or builtin:...
    uint64_t scene = 0;     ///< sceneHash()
    uint64_t cameras = 0;   ///< cameraHash()
    std::string camera;     ///< cameraText() of frame 0
};

/// Entries of AccumulationHeader::identity that are asked for by name.
inline constexpr const char* sceneEntry = "the scene";
inline constexpr const char* cameraEntry = "the first camera";
inline constexpr const char* seedEntry = "seed";
inline constexpr const char* versionEntry = "the version of Limpid";

/// For AccumulationHeader::identity: scene, camera, timing, settings, tracer and version. What has a member
/// of its own there (size, samples, layers) is not in it, and neither is the device.
std::vector<std::pair<std::string, std::string>> identityOf(const RenderIdentity& identity,
                                                            const RenderSettings& settings,
                                                            const SequenceTiming& timing);

/// JSON holds UTF-8 only; a file's or a device's name may be anything.
std::string validUtf8(const std::string& text);

}  // namespace limpid
