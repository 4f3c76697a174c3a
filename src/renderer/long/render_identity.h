// Everything that determines a render's pixels, as text, so that samples of different renders are never
// mixed.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "renderer/method/settings.h"
#include "renderer/sequence/sequence.h"

namespace limpid {

/// Hash of all scene data on the device (trees, materials, textures, lights, environment) and of the
/// animation that moves it. `data` was built from `scene`.
uint64_t sceneHash(const scene::Scene& scene, const scene::SceneData& data);

/// Hash of the cameras of all frames, or of a thousand evenly spaced ones if there are more; and of all keys
/// of the camera's path if cameras between these times matter, too.
uint64_t cameraHash(const Sequence& sequence, uint64_t frames, gpu::Extent extent);

struct RenderIdentity {
    std::string version;    ///< version of Limpid
    std::string sceneName;  ///< the file's name without folders, or builtin:...
    uint64_t scene = 0;     ///< sceneHash()
    uint64_t cameras = 0;   ///< cameraHash()
    std::string camera;     ///< cameraText() of frame 0
};

/// Entries of AccumulationHeader::identity that are looked up by name.
inline constexpr const char* sceneEntry = "the scene";
inline constexpr const char* cameraEntry = "the first camera";
inline constexpr const char* seedEntry = "seed";
inline constexpr const char* jitterEntry = "jitter";
inline constexpr const char* versionEntry = "the version of Limpid";

/// For AccumulationHeader::identity: scene, camera, timing, settings, tracer and version. It does
/// not contain what has its own member there (size, samples, layers), nor the device.
std::vector<std::pair<std::string, std::string>> identityOf(const RenderIdentity& identity,
                                                            const RenderSettings& settings,
                                                            const SequenceTiming& timing);

/// Makes text valid UTF-8 for JSON; names of files and devices may contain any bytes.
std::string validUtf8(const std::string& text);

}  // namespace limpid
