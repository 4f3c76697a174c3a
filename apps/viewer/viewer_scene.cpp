// The scene and the lights in the window: opening, changing and restarting.
#include <algorithm>

#include "scene/motion/movement.h"
#include "viewer/panel/light_desk.h"
#include "viewer_session.h"

namespace limpid::viewer {
/// Loads a scene; leaves everything unchanged if that fails. The command line's camera and clip apply to its
/// own scene only.
void Viewer::load(const scene::SceneSource& source) {
    scene::Scene scene = load_(source);
    if (!scene.rig.clips.empty()) scene::chooseClip(scene, "");
    const scene::Camera home = scene.cameras.front();
    show(std::move(scene));
    goTo(home);
    const LightDesk before = panel_.lights;
    const bool same = source.scene == settings_.source.scene,
               sameSky = source.environment == settings_.source.environment;
    settings_.source = source;
    settings_.source.lightFile.clear();
    settings_.startCamera.clear();
    panel_.lights.show(stage_->originalLights(), settings_.source);
    if (same) panel_.lights.carry(before, sameSky);
}

void Viewer::show(scene::Scene scene) {
    auto stage = std::make_unique<Stage>(device_, std::move(scene), tracer_(device_));
    device_.waitIdle();
    main_.drop();
    comparison_.drop();
    stage_ = std::move(stage);
    ++scenesShown_;
    window_.setTitle("Limpid: " + stage_->scene().name);
    facts_.sceneRadius = std::max(stage_->sphere().radius, 1e-3f);
    playback_.reset(0.0);
}

/// Resets camera, speed and time for a scene that was just opened.
void Viewer::goTo(const scene::Camera& home) {
    rig_.show(*stage_, home);
    speed_ = 0.25f * stage_->sphere().radius;
    facts_.cameras = rig_.names();
    facts_.duration = stage_->duration();
    panel_.asked.measureExposure = panel_.asked.resetCamera = true;
}

/// Opens an environment map around the current scene, or a scene.
void Viewer::open(const std::string& file, Arrival arrival) {
    const std::string extension = std::filesystem::path(file).extension().string();
    scene::SceneSource source = settings_.source;
    if (extension == ".hdr" || extension == ".exr" || extension == ".pic") {
        source.environment = file;
        source.background.clear();
    } else {
        source.scene = file;
        // A dropped file does not imply permission to read the folders around its own.
        source.assetRoot =
            arrival == Arrival::Dropped ? std::filesystem::absolute(file).parent_path().string() : "";
    }
    load(source);
    say("opened " + file);
}

/// Adds or removes lamps and the background.
void Viewer::applyLightRequests() {
    PanelRequests& asked = panel_.asked;
    if (!asked.relight && !asked.addPoint && !asked.addSun && asked.removeLamp < 0) return;
    scene::SceneSource source = settings_.source;
    if (asked.addPoint || asked.addSun)
        source.lights.push_back(newLamp(asked.addSun, panel_.pose.eye, panel_.pose.target, panel_.exposure));
    if (asked.removeLamp >= 0) removeLamp(asked.removeLamp, source, panel_.lights);
    source.background = panel_.lights.backgroundText();
    asked.addPoint = asked.addSun = asked.relight = false;
    asked.removeLamp = -1;
    attempt([&] { relight(source); });
}

/// Loads the scene again with other lights; everything else is kept.
void Viewer::relight(const scene::SceneSource& source) {
    scene::Scene scene = load_(source);
    const double time = playback_.time();
    if (stage_->moves()) scene::chooseClip(scene, scene::clipChoice(stage_->scene()));
    show(std::move(scene));
    playback_.reset(time);
    // The scene's file may have changed since.
    rig_.keep(*stage_);
    panel_.camera = rig_.chosen();
    facts_.cameras = rig_.names();
    const std::string backgroundBefore = settings_.source.background;
    settings_.source = source;
    const LightDesk before = panel_.lights;
    panel_.lights.show(stage_->originalLights(), source);
    panel_.lights.carry(before, source.background == backgroundBefore);
}

/// Makes the next frame the first one.
void Viewer::startAnew() {
    playback_.reset(playback_.time());
    main_.drop();
    comparison_.drop();
}

}  // namespace limpid::viewer
