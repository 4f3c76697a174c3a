// Shared by the fuzz targets: a folder in memory for input files, and the steps that bring a scene to the
// device.
#pragma once

#include <filesystem>
#include <string_view>

#include "base/error.h"
#include "scene/device/scene_data.h"
#include "scene/model/scene.h"
#include "targets.h"

namespace limpid::fuzz {

/// A folder of this process, in memory if the system supports it; removed when the process ends.
class Scratch {
  public:
    Scratch();
    ~Scratch();
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    /// Writes a file into the folder and returns its path. Throws Error, not InputError, if it cannot.
    std::filesystem::path write(std::string_view name, Bytes content) const;
    void remove(std::string_view name) const;

  private:
    std::filesystem::path folder_;
};

/// Returns the process's only folder; it contains the picture "a.png" of 2x2 pixels.
const Scratch& scratch();

/// Loads a scene file, prepares and packs it for the device like `limpid render`, and plays its clips.
/// Returns false if it was refused.
bool reachesDevice(const std::filesystem::path& sceneFile);

/// The steps of buildSceneData() that depend on the scene.
scene::SceneData pack(const scene::Scene& scene);

/// Calls `read`; returns false if it threw InputError.
template <typename Read>
bool accepts(const Read& read) {
    try {
        read();
        return true;
    } catch (const InputError&) {
        return false;
    }
}

struct Parts {
    Bytes first, second;
    bool split = false;  ///< there is a zero byte, which belongs to neither part
};
Parts splitAtZero(Bytes input);

}  // namespace limpid::fuzz
