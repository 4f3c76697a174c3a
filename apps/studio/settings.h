// How a studio starts.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "gpu/vulkan/device.h"
#include "renderer/method/settings.h"
#include "scene/device/trees/tracer.h"
#include "scene/load/scene_source.h"
#include "scene/model/scene.h"
#include "studio/background/networks.h"
#include "studio/background/scene_loading.h"
#include "studio/state/state.h"

namespace limpid::studio {

struct StudioSettings {
    scene::SceneSource source;
    std::string startCamera;       ///< options of the command line that chose the camera of the first scene;
                                   ///< empty: its first
    std::string animation;         ///< clip by name or number, or "all"; empty: the first one
    RenderSettings render;         ///< its extent is the viewport's at first
    std::optional<Jitter> jitter;  ///< empty: as the pipeline needs it
    bool preview = false;          ///< starts with the integrator `preview` instead of the chosen one
    uint32_t samples = 1;          ///< per pixel and frame
    /// Samples per pixel at which a picture in which nothing changes is finished.
    uint64_t maxSamples = 4096;
    Resolution resolution = Resolution::Automatic;
    /// Pictures are for a display of a high dynamic range: with ToneCurve::None, they exceed 1.
    bool extended = false;
    /// Fields that are set once the first scene is there (state_json.h); null: none.
    nlohmann::json state;
    /// A frame begins while the picture of the one before it is brought to the host. Empty: except on CPUs,
    /// which would compute that frame first.
    std::optional<bool> overlaps;
    bool writesFiles = true;           ///< requests may write into the working folder
    std::filesystem::path weights;     ///< of networks; empty: those that come with Limpid
    NetworkLoader loadNetworks;        ///< empty: limpid::loadNetworks()
    std::filesystem::path shaders;     ///< Limpid's src: shaders are compiled anew when saved; empty: not
    uint64_t quitAfter = 0;            ///< frames, which are rendered also where nothing changes; 0: no limit
    std::filesystem::path screenshot;  ///< .png or .exr, written when the studio ends; empty: none
    uint64_t loseDeviceAt = 0;         ///< for tests: after so many frames, as if; 0: never
};

/// How rays are traced on the device that there is.
using TracerChoice = std::function<scene::Tracer(const gpu::Device&)>;

/// Returns the camera that the first scene is seen by. Throws UsageError.
using CameraStart = std::function<scene::Camera(const scene::Scene&)>;

}  // namespace limpid::studio
