// `limpid view`: a scene in a window, to fly through; every integrator, denoiser and parameter.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "gpu/vulkan/device.h"
#include "renderer/frame/settings.h"
#include "scene/device/tracer.h"
#include "scene/model/scene.h"
#include "scene/model/scene_source.h"

namespace limpid::viewer {

struct ViewSettings {
    scene::SceneSource source;
    std::string startCamera;       ///< options of the command line that chose the camera of the first scene;
                                   ///< empty: its first
    std::string animation;         ///< clip by name or number, or "all"; empty: the first one
    RenderSettings render;         ///< its extent is the window's
    std::optional<Jitter> jitter;  ///< empty: as the pipeline needs it
    bool preview = false;          ///< it starts with the integrator `preview` instead of the chosen one
    uint32_t samples = 1;          ///< per pixel and frame
    /// Frames in which nothing changes, times samples; then nothing is computed until something does.
    uint64_t maxSamples = 4096;
    /// 2^shrink pixels of the window for one of the picture's, along each axis. Below 0: 0, but on CPUs so
    /// much that the picture has at most 300,000 pixels.
    int shrink = -1;
    std::filesystem::path
        controls;                   ///< file that says where the panel's controls are, for tests; empty: none
    std::filesystem::path kept;     ///< file that these are written to on leaving; empty: none
    std::filesystem::path weights;  ///< of networks; empty: those that come with Limpid
    std::filesystem::path shaders;  ///< Limpid's src: shaders are compiled anew when saved; empty: not
    uint64_t quitAfter = 0;         ///< frames; 0: when the window is closed
    uint64_t loseDeviceAt = 0;      ///< for tests: after so many frames, as if; 0: never
    std::filesystem::path screenshot;  ///< .png or .exr written on leaving; empty: none
};

/// How rays are traced on the device that there is.
using TracerChoice = std::function<scene::Tracer(const gpu::Device&)>;

/// A complete scene (scene/model/prepare.h). Throws InputError, and UsageError.
using SceneLoader = std::function<scene::Scene(const scene::SceneSource& source)>;

/// Opens the window and returns when it is closed. Throws Error where there is no display, or a device that
/// cannot show pictures; and what the loader throws.
void view(const gpu::DeviceOptions& device, const TracerChoice& tracer, const SceneLoader& load,
          const std::function<scene::Camera(const scene::Scene&)>& start, const ViewSettings& settings);

}  // namespace limpid::viewer
