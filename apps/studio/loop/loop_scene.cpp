// The scene and its lights: opening, changing and restarting.
#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "base/text/lower_case.h"
#include "scene/lights/light_file.h"
#include "scene/motion/movement.h"
#include "studio/loop/render_loop.h"
#include "studio/state/light_desk.h"

namespace limpid::studio {

std::optional<SceneLoading::Order> RenderLoop::firstScene(const StudioSettings& settings) {
    if (settings.source.scene.empty()) return {};
    return SceneLoading::Order{
        .source = settings.source, .why = SceneLoading::Why::First, .clip = settings.animation};
}

/// What another change is made to, so that none is lost: what is being loaded, or the scene that is shown.
SceneLoading::Order RenderLoop::orderToChange() const {
    if (loading_) return loading_.order();
    SceneLoading::Order order{.source = settings_.source, .why = SceneLoading::Why::Relit};
    if (stage_ && stage_->moves()) order.clip = scene::clipChoice(stage_->scene());
    return order;
}

/// Shows the scene that was being loaded, if that is done; leaves everything unchanged if it failed. Throws
/// what the loader throws if it was the scene that the studio starts with.
void RenderLoop::finishLoading() {
    if (!loading_ || !loading_.isDone()) return;
    const SceneLoading::Order order = loading_.order();
    changedFacts_ = true;
    if (order.why == SceneLoading::Why::First) return showFirst(loading_.take());
    const bool shown = attempt([&] {
        LoadedScene scene = loading_.take();
        if (order.why == SceneLoading::Why::Relit)
            showRelit(std::move(scene), order);
        else
            showOpened(std::move(scene), order);
        if (!order.message.empty()) say(order.message);
    });
    if (!shown) state_.lights.showBackground(settings_.source);
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
void RenderLoop::showOpened(LoadedScene scene, const SceneLoading::Order& order) {
    const scene::Camera home = scene.scene.cameras.front();
    show(std::move(scene));
    goTo(home);
    const LightDesk before = deskWithout(order.gone);
    const bool same = order.source.scene == settings_.source.scene,
               sameSky = order.source.environment == settings_.source.environment;
    settings_.source = order.source;
    settings_.source.lightFile.clear();
    settings_.startCamera.clear();
    state_.lights.show(stage_->originalLights(), settings_.source);
    if (same) state_.lights.carry(before, sameSky);
}

void RenderLoop::show(LoadedScene scene) {
    std::vector<std::string> notes = std::move(scene.notes);
    auto stage = std::make_unique<Stage>(device_, std::move(scene), tracer_(device_));
    device_.waitIdle();
    main_.drop();
    comparison_.drop();
    stage_ = std::move(stage);
    isNew_ = true;
    rendered_.reset();
    hasFailed_ = false;
    ++facts_.scenesShown;
    facts_.scene = stage_->scene().name;
    facts_.notes = std::move(notes);
    facts_.allValues.clear();
    probeAt_.reset();
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
    const std::string extension = lowerCase(std::filesystem::path(file).extension().string());
    SceneLoading::Order order = orderToChange();
    order.why = SceneLoading::Why::Opened;
    order.clip = "";
    order.message = "opened " + file;
    if (extension == ".hdr" || extension == ".exr" || extension == ".pic") {
        order.source.environment = file;
        order.source.background.clear();
    } else {
        order.source.scene = file;
        // A dropped file does not imply permission to read the folders around its own.
        order.source.assetRoot = dropped ? std::filesystem::absolute(file).parent_path().string() : "";
    }
    loading_.begin(std::move(order));
}

void RenderLoop::addLamp(bool sun) {
    SceneLoading::Order order = orderToChange();
    order.source.lights.push_back(newLamp(sun, state_.pose.eye, state_.pose.target, state_.exposure));
    loading_.begin(std::move(order));
}

/// The desk keeps the lamp until the scene without it is shown: loading may fail, or be given up.
void RenderLoop::takeLampAway(int index) {
    const int number = index - state_.lights.firstAdded;
    if (number < 0 || static_cast<size_t>(number) >= settings_.source.lights.size()) return;
    SceneLoading::Order order = orderToChange();
    if (std::ranges::find(order.gone, number) != order.gone.end()) return;
    const auto before = std::ranges::count_if(order.gone, [&](int each) { return each < number; });
    order.source.lights.erase(order.source.lights.begin() + (number - before));
    order.gone.push_back(number);
    loading_.begin(std::move(order));
}

/// Loads the scene again with the background that was chosen.
void RenderLoop::changeBackground() {
    SceneLoading::Order order = orderToChange();
    order.source.background = state_.lights.backgroundText();
    loading_.begin(std::move(order));
}

/// The lights of the scene that is shown, as if these lamps had never been added to it.
LightDesk RenderLoop::deskWithout(std::vector<int> lamps) const {
    LightDesk desk = state_.lights;
    scene::SceneSource source = settings_.source;
    std::ranges::sort(lamps, std::greater());  // the others keep their numbers
    for (const int number : lamps) removeLamp(desk.firstAdded + number, source, desk);
    return desk;
}

/// Shows the same scene with other lights; everything else is kept.
void RenderLoop::showRelit(LoadedScene scene, const SceneLoading::Order& order) {
    const double time = playback_.time();
    show(std::move(scene));
    playback_.reset(time);
    flight_.reset(time);
    // The scene's file may have changed since.
    rig_.keep(*stage_);
    state_.camera = rig_.chosen();
    facts_.cameras = rig_.names();
    const LightDesk before = deskWithout(order.gone);
    const bool sameSky = order.source.background == settings_.source.background;
    settings_.source = order.source;
    state_.lights.show(stage_->originalLights(), settings_.source);
    state_.lights.carry(before, sameSky);
}

/// Makes the next frame the first one.
void RenderLoop::startAnew() {
    playback_.reset(playback_.time());
    flight_.reset(playback_.time());
    main_.drop();
    comparison_.drop();
}

}  // namespace limpid::studio
