#include "viewer/viewer.h"

#include <chrono>
#include <memory>
#include <thread>

#include "base/error.h"
#include "base/log.h"
#include "studio/state/kept_settings.h"
#include "studio/studio.h"
#include "viewer/viewer_window.h"

namespace limpid::viewer {
namespace {

constexpr std::chrono::milliseconds windowlessTime(300);

/// What is wrong with the scene needs no display to be told.
std::unique_ptr<Desktop> openDesktop(const studio::SceneLoader& load, const studio::CameraStart& start,
                                     const scene::SceneSource& source) {
    try {
        return std::make_unique<Desktop>();
    } catch (const Error&) {
        if (!source.scene.empty()) start(load(source, {}));
        throw;
    }
}

/// Waits a moment for the scene, so that no window appears and vanishes where it cannot be loaded.
void waitForScene(const studio::Studio& studio) {
    const auto end = std::chrono::steady_clock::now() + windowlessTime;
    while (!studio.hasEnded() && studio.shown()->facts.scene.empty() &&
           std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

}  // namespace

void view(const gpu::DeviceOptions& device, const studio::TracerChoice& tracer,
          const studio::SceneLoader& load, const studio::CameraStart& start, const ViewSettings& settings) {
    const auto desktop = openDesktop(load, start, settings.studio.source);
    studio::Studio studio(device, tracer, load, start, settings.studio);
    waitForScene(studio);
    if (studio.hasEnded()) return studio.finish();
    ViewerWindow window(device, settings);
    window.run(studio);
    const studio::State last = window.state();
    studio.finish();
    try {
        studio::keepSettings(settings.kept, studio::settingsOf(last, settings.studio));
    } catch (const Error& fault) {
        log::warn("{}", fault.what());
    }
    window.finish();
}

}  // namespace limpid::viewer
