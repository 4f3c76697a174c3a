// `limpid view`: a scene in a window, to fly through; every integrator, denoiser and parameter.
#pragma once

#include <filesystem>
#include <optional>

#include "studio/settings.h"

namespace limpid::viewer {

struct ViewSettings {
    studio::StudioSettings studio;  ///< studio.render.extent is the window's size at first
    std::filesystem::path
        controls;                ///< file that says where the panel's controls are, for tests; empty: none
    std::filesystem::path kept;  ///< file that these are written to on leaving; empty: none
    // Output of a high dynamic range (looks/memory.h); empty: as the window remembers it.
    std::optional<bool> hdr;
    std::optional<float> paperWhite, peak;
};

/// Opens the window and returns when it is closed. Throws Error where there is no display, or a device that
/// cannot show pictures; and what the loader and `start` throw.
void view(const gpu::DeviceOptions& device, const studio::TracerChoice& tracer,
          const studio::SceneLoader& load, const studio::CameraStart& start, const ViewSettings& settings);

}  // namespace limpid::viewer
