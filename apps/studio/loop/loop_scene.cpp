// The scene and its lights: opening, changing and restarting.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "scene/lights/light_file.h"
#include "scene/motion/movement.h"
#include "studio/loop/render_loop.h"
#include "studio/state/light_desk.h"

namespace limpid::studio {
/// Begins to load a scene, while the old one is shown. A scene that is being loaded already is given up.
void RenderLoop::load(const scene::SceneSource& source, SceneLoading::Why why, std::string message) {
    const bool relights = why == SceneLoading::Why::Relit;
    std::optional<std::string> clip = "";
    if (why == SceneLoading::Why::First) clip = settings_.animation;
    if (relights) clip = stage_->moves() ? std::optional(scene::clipChoice(stage_->scene())) : std::nullopt;
    loading_.begin({source, why, std::move(clip), std::move(message)});
}

/// Shows the scene that was being loaded, if that is done; leaves everything unchanged if it failed. Throws
/// what the loader throws if it was the scene that the studio starts with.
void RenderLoop::finishLoading() {
    if (!loading_ || !loading_.isDone()) return;
    const SceneLoading::Order order = loading_.order();
    changedFacts_ = true;
    if (order.why == SceneLoading::Why::First) return showFirst(loading_.take());
    attempt([&] {
        LoadedScene scene = loading_.take();
        if (order.why == SceneLoading::Why::Relit)
            showRelit(std::move(scene), order.source);
        else
            showOpened(std::move(scene), order.source);
        if (!order.message.empty()) say(order.message);
    });
}

/// Shows the scene that the studio starts with.
void RenderLoop::showFirst(LoadedScene scene) {
    const scene::Camera home = start_(scene.scene);
    show(std::move(scene));
    state_.lights.show(stage_->originalLights(), settings_.source);
    if (!settings_.source.lightFile.empty())
        state_.lights.lights = scene::readLightFile(settings_.source.lightFile, state_.lights.original);
    goTo(home);
    if (settings_.state.is_null()) return;
    if (settings_.state.contains("exposure")) measureExposure_ = false;
    edit(std::exchange(settings_.state, {}));
    if (!facts_.fault.empty()) throw UsageError("--state: " + facts_.fault);
}

/// Shows a scene that was opened. The command line's camera and clip apply to its own scene only.
void RenderLoop::showOpened(LoadedScene scene, const scene::SceneSource& source) {
    const scene::Camera home = scene.scene.cameras.front();
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

void RenderLoop::show(LoadedScene scene) {
    auto stage = std::make_unique<Stage>(device_, std::move(scene), tracer_(device_));
    device_.waitIdle();
    main_.drop();
    comparison_.drop();
    stage_ = std::move(stage);
    isNew_ = true;
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
    load(source, SceneLoading::Why::Opened, "opened " + file);
}

void RenderLoop::addLamp(bool sun) {
    scene::SceneSource source = settings_.source;
    source.lights.push_back(newLamp(sun, state_.pose.eye, state_.pose.target, state_.exposure));
    load(source, SceneLoading::Why::Relit, "");
}

void RenderLoop::takeLampAway(int index) {
    scene::SceneSource source = settings_.source;
    removeLamp(index, source, state_.lights);
    load(source, SceneLoading::Why::Relit, "");
}

/// Loads the scene again with the background that was chosen.
void RenderLoop::changeBackground() {
    scene::SceneSource source = settings_.source;
    source.background = state_.lights.backgroundText();
    load(source, SceneLoading::Why::Relit, "");
}

/// Shows the same scene with other lights; everything else is kept.
void RenderLoop::showRelit(LoadedScene scene, const scene::SceneSource& source) {
    const double time = playback_.time();
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
