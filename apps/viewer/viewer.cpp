#include "viewer/viewer.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "studio/kept_settings.h"
#include "studio/studio.h"
#include "viewer/viewer_window.h"

namespace limpid::viewer {

void view(const gpu::DeviceOptions& device, const studio::TracerChoice& tracer,
          const studio::SceneLoader& load, const studio::CameraStart& start, const ViewSettings& settings) {
    const Desktop desktop;
    ViewerWindow window(device, settings);
    studio::Studio studio(device, tracer, load, start, settings.studio);
    window.run(studio);
    const auto last = studio.shown();
    studio.finish();
    try {
        if (last->number > 0)
            studio::keepSettings(settings.kept, studio::settingsOf(last->state, settings.studio));
    } catch (const Error& fault) {
        log::warn("{}", fault.what());
    }
    window.finish();
}

}  // namespace limpid::viewer
