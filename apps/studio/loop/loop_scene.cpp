// The scene and its lights: opening, changing and restarting.
#include <algorithm>
#include <chrono>

#include "scene/model/light_file.h"
#include "scene/motion/movement.h"
#include "studio/loop/render_loop.h"
#include "studio/state/light_desk.h"

namespace limpid::studio {
/// Loads the scene that the studio starts with. Throws what the loader throws.
void RenderLoop::loadFirst() {
    facts_.activity = "loading " + settings_.source.scene;
    publish();
    scene::Scene scene = load_(settings_.source);
    if (!scene.rig.clips.empty()) scene::chooseClip(scene, settings_.animation);
    const scene::Camera home = start_(scene);
    show(std::move(scene));
    state_.lights.show(stage_->originalLights(), settings_.source);
    if (!settings_.source.lightFile.empty())
        state_.lights.lights = scene::readLightFile(settings_.source.lightFile, state_.lights.original);
    goTo(home);
    facts_.activity.clear();
    if (settings_.state.is_null()) return;
    if (settings_.state.contains("exposure")) measureExposure_ = false;
    edit(std::exchange(settings_.state, {}));
    if (!facts_.fault.empty()) throw UsageError("--state: " + facts_.fault);
}

/// Begins to load a scene, while the old one is shown. A scene that is being loaded already is given up.
void RenderLoop::load(const scene::SceneSource& source, bool relights, std::string message) {
    std::erase_if(cancelled_, [](const auto& scene) {
        return scene.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    if (loading_) cancelled_.push_back(std::move(loading_->scene));
    facts_.activity = relights ? "changing the lights" : "loading " + source.scene;
    loading_ = Loading{source, relights, std::move(message),
                       std::async(std::launch::async, [this, source] { return load_(source); })};
}

/// Shows the scene that was being loaded, if that is done; leaves everything unchanged if it failed.
void RenderLoop::finishLoading() {
    if (!loading_ || loading_->scene.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    Loading done = std::move(*loading_);
    loading_.reset();
    facts_.activity.clear();
    changedFacts_ = true;
    attempt([&] {
        scene::Scene scene = done.scene.get();
        if (done.relights)
            showRelit(std::move(scene), done.source);
        else
            showOpened(std::move(scene), done.source);
        if (!done.message.empty()) say(done.message);
    });
}

/// Shows a scene that was opened. The command line's camera and clip apply to its own scene only.
void RenderLoop::showOpened(scene::Scene scene, const scene::SceneSource& source) {
    if (!scene.rig.clips.empty()) scene::chooseClip(scene, "");
    const scene::Camera home = scene.cameras.front();
    show(std::move(scene));
    goTo(home);
    const LightDesk before = state_.lights;
    const bool same = source.scene == settings_.source.scene,
               sameSky = source.environment == settings_.source.environment;
    settings_.source = source;
    settings_.source.lightFile.clear();
    settings_.startCamera.clear();
    state_.lights.show(stage_->originalLights(), settings_.source);
    if (same) state_.lights.carry(before, sameSky);
}

void RenderLoop::show(scene::Scene scene) {
    auto stage = std::make_unique<Stage>(device_, std::move(scene), tracer_(device_));
    device_.waitIdle();
    main_.drop();
    comparison_.drop();
    stage_ = std::move(stage);
    ++facts_.scenesShown;
    facts_.scene = stage_->scene().name;
    facts_.sceneRadius = std::max(stage_->sphere().radius, 1e-3f);
    playback_.reset(0.0);
    flight_.reset(0.0);
}

/// Resets camera, speed and time for a scene that was just opened.
void RenderLoop::goTo(const scene::Camera& home) {
    rig_.show(*stage_, home);
    speed_ = 0.25f * stage_->sphere().radius;
    facts_.cameras = rig_.names();
    facts_.duration = stage_->duration();
    measureExposure_ = true;
    resetCamera();
}

/// Opens an environment map around the current scene, or a scene.
void RenderLoop::open(const std::string& file, bool dropped) {
    const std::string extension = std::filesystem::path(file).extension().string();
    scene::SceneSource source = settings_.source;
    if (extension == ".hdr" || extension == ".exr" || extension == ".pic") {
        source.environment = file;
        source.background.clear();
    } else {
        source.scene = file;
        // A dropped file does not imply permission to read the folders around its own.
        source.assetRoot = dropped ? std::filesystem::absolute(file).parent_path().string() : "";
    }
    load(source, false, "opened " + file);
}

void RenderLoop::addLamp(bool sun) {
    scene::SceneSource source = settings_.source;
    source.lights.push_back(newLamp(sun, state_.pose.eye, state_.pose.target, state_.exposure));
    load(source, true, "");
}

void RenderLoop::takeLampAway(int index) {
    scene::SceneSource source = settings_.source;
    removeLamp(index, source, state_.lights);
    load(source, true, "");
}

/// Loads the scene again with the background that was chosen.
void RenderLoop::changeBackground() {
    scene::SceneSource source = settings_.source;
    source.background = state_.lights.backgroundText();
    load(source, true, "");
}

/// Shows the same scene with other lights; everything else is kept.
void RenderLoop::showRelit(scene::Scene scene, const scene::SceneSource& source) {
    const double time = playback_.time();
    if (stage_->moves()) scene::chooseClip(scene, scene::clipChoice(stage_->scene()));
    show(std::move(scene));
    playback_.reset(time);
    flight_.reset(time);
    // The scene's file may have changed since.
    rig_.keep(*stage_);
    state_.camera = rig_.chosen();
    facts_.cameras = rig_.names();
    const std::string backgroundBefore = settings_.source.background;
    settings_.source = source;
    const LightDesk before = state_.lights;
    state_.lights.show(stage_->originalLights(), source);
    state_.lights.carry(before, source.background == backgroundBefore);
}

/// Makes the next frame the first one.
void RenderLoop::startAnew() {
    playback_.reset(playback_.time());
    flight_.reset(playback_.time());
    main_.drop();
    comparison_.drop();
}

}  // namespace limpid::studio
