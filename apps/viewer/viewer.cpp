#include "viewer.h"

#include <memory>

#include "base/error.h"
#include "base/log.h"
#include "scene/model/light_file.h"
#include "scene/motion/movement.h"
#include "viewer_session.h"

namespace limpid::viewer {
namespace {

constexpr uint64_t minFramesOfADevice = 30;  ///< a device lost sooner would be lost again

/// Opens the viewer again in the same state, on another device or on the same one if it is available again.
std::unique_ptr<Viewer> afterLoss(const gpu::DeviceOptions& device, const TracerChoice& tracer,
                                  const SceneLoader& load, std::unique_ptr<Viewer> lost) {
    ViewSettings now = lost->settingsNow();
    now.loseDeviceAt = 0;
    const Viewer::Standing standing = lost->standing();
    now.render.denoisers = standing.panel.render.denoisers;
    lost.reset();
    scene::Scene scene = load(now.source);
    if (!standing.clip.empty()) scene::chooseClip(scene, standing.clip);
    auto viewer = std::make_unique<Viewer>(device, tracer, load, std::move(scene), standing.home, now);
    viewer->takeOver(standing);
    return viewer;
}

}  // namespace

void view(const gpu::DeviceOptions& device, const TracerChoice& tracer, const SceneLoader& load,
          const std::function<scene::Camera(const scene::Scene&)>& start, const ViewSettings& settings) {
    // Before there is a window, since errors in these do not need one.
    scene::Scene first = load(settings.source);
    if (!first.rig.clips.empty()) scene::chooseClip(first, settings.animation);
    const scene::Camera home = start(first);
    if (!settings.source.lightFile.empty())
        scene::readLightFile(settings.source.lightFile, scene::lightControlsOf(first));
    const Desktop desktop;
    auto viewer = std::make_unique<Viewer>(device, tracer, load, std::move(first), home, settings);
    for (;;) {
        try {
            viewer->run();
            return viewer->storePipelines();
        } catch (const gpu::DeviceLost& fault) {
            if (viewer->rendered() < minFramesOfADevice) throw;
            log::error("{}; setting everything up anew", fault.what());
        }
        viewer = afterLoss(device, tracer, load, std::move(viewer));
    }
}

}  // namespace limpid::viewer
