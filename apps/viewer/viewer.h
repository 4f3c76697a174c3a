// `limpid view`: a scene in a window, to fly through; every pipeline, every parameter.
#pragma once

#include <filesystem>
#include <functional>

#include "gpu/device.h"
#include "renderer/settings.h"
#include "scene/scene.h"
#include "scene/tracer.h"

namespace limpid::viewer {

struct ViewSettings {
    RenderSettings render;  ///< its extent is the window's
    uint32_t samples = 1;   ///< per pixel and frame
    uint64_t maxSamples =
        4096;  ///< of pictures that accumulate; then nothing is computed until something changes
    std::filesystem::path weights;     ///< of networks; empty: those that come with Limpid
    uint64_t quitAfter = 0;            ///< frames; 0: when the window is closed
    std::filesystem::path screenshot;  ///< PNG written on leaving; empty: none
};

/// How rays are traced on the device that there is.
using TracerChoice = std::function<scene::Tracer(const gpu::Device&)>;

/// Opens the window and returns when it is closed. Throws Error where there is no display, or a device that
/// cannot show pictures.
void view(const gpu::DeviceOptions& device, const TracerChoice& tracer, scene::Scene scene,
          const scene::Camera& camera, const ViewSettings& settings);

}  // namespace limpid::viewer
