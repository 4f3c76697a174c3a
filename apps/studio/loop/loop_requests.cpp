// What clients ask of the renderer: edits of the state, gestures, requests.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "scene/framing/framing.h"
#include "studio/compare/history_text.h"
#include "studio/compare/pixel_at.h"
#include "studio/loop/render_loop.h"
#include "studio/state/state_json.h"

namespace limpid::studio {
namespace {

template <typename... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <typename... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace

void RenderLoop::handle(const Message& message) {
    std::visit(Overloaded{[&](const nlohmann::json& changes) { edit(changes); },
                          [&](const Gesture& gesture) { steer(gesture); },
                          [&](const Request& request) { carryOut(request); }},
               message.content);
}

/// Sets fields, and does what follows from them at once.
void RenderLoop::edit(const nlohmann::json& changes) {
    const auto names = [&](std::initializer_list<const char*> keys) {
        return std::ranges::any_of(keys, [&](const char* key) { return changes.contains(key); });
    };
    const State before = state_;
    if (!attempt([&] { apply(state_, changes); }) || !stage_) return;
    const bool chosen = state_.camera != before.camera;
    if (chosen) {
        state_.camera = std::clamp(state_.camera, 0, static_cast<int>(facts_.cameras.size()) - 1);
        rig_.choose(*stage_, state_.camera);
        if (!names({"playing"})) state_.playing |= rig_.movesOnPath();
        startAnew();
    }
    // What is said together with another camera than the free one is that camera's.
    if (!chosen || rig_.isFree()) {
        if (names({"eye", "target", "up"})) placeCamera();
        if (names({"half_height"})) {
            freeCamera();
            rig_.hand().setHalfHeight(state_.halfHeight);
        }
    }
    if (names({"time"})) {
        playback_.seek(double{state_.time});
        flight_.seek(double{state_.time});
    }
    if (names({"background"}) && state_.lights.backgroundText() != before.lights.backgroundText())
        changeBackground();
}

void RenderLoop::steer(const Gesture& gesture) {
    if (!stage_ || !gesture.moves()) return;
    freeCamera();
    gesture.apply(rig_.hand(), speed_);
    showPose();
}

/// The camera stays where it is, and can be moved.
void RenderLoop::freeCamera() {
    if (rig_.isFree()) return;
    rig_.setFree(*stage_, playback_.time());
    state_.camera = rig_.chosen();
    state_.fovDegrees = glm::degrees(rig_.hand().camera().verticalFov);
    startAnew();
}

void RenderLoop::carryOut(const Request& request) {
    using Kind = Request::Kind;
    const Kind kind = request.kind;
    if (kind != Kind::Extended) facts_.fault.clear();  // something new is being done
    if (kind == Kind::Open || kind == Kind::OpenDropped)
        return void(attempt([&] { open(request.file, kind == Kind::OpenDropped); }));
    if (kind == Kind::CancelLoading) return cancelLoading();
    if (kind == Kind::Extended) settings_.extended = request.index != 0;
    if (!stage_) return;
    if (kind == Kind::Reset) startAnew();
    if (kind == Kind::Step) step_ = true;
    if (kind == Kind::MeasureExposure) measureExposure_ = true;
    if (kind == Kind::ResetCamera) resetCamera();
    if (kind == Kind::SeeAll) seeAll();
    if (kind == Kind::Focus) attempt([&] { focus(request.position); });
    if (kind == Kind::Probe && main_) probe(request.position);
    if (kind == Kind::AddPoint || kind == Kind::AddSun) attempt([&] { addLamp(kind == Kind::AddSun); });
    if (kind == Kind::RemoveLamp) attempt([&] { takeLampAway(request.index); });
    if (kind == Kind::KeepSettings) state_.comparison.keep(withParts(state_.render, state_.parts));
    if (kind == Kind::SaveLights) attempt([&] { saveLights(); });
    if (kind == Kind::SavePath) attempt([&] { savePath(); });
    if (kind == Kind::SavePng) toSave_.emplace_back(".png");
    if (kind == Kind::SaveExr) toSave_.emplace_back(".exr");
    if (kind == Kind::CommandLine) attempt([&] { makeCommand(); });
}

/// Asks for the values of another pixel, or hides those of this one.
void RenderLoop::probe(const std::array<float, 2>& position) {
    const gpu::Extent extent = wanted_.extent;
    const auto pixelOf = [&](const std::array<float, 2>& at) {
        return std::pair(pixelAt(at[0], extent.width), pixelAt(at[1], extent.height));
    };
    if (facts_.allValues.empty() || pixelOf(position) != pixelOf(facts_.probedAt)) {
        probeAt_ = position;
        return;
    }
    facts_.allValues.clear();
    probeAt_.reset();
}

void RenderLoop::resetCamera() {
    state_.camera = 0;
    state_.fovDegrees = glm::degrees(rig_.home().verticalFov);
    rig_.goHome(*stage_);
    startAnew();
}

void RenderLoop::seeAll() {
    rig_.stand(*stage_, scene::frameScene(stage_->scene()));
    state_.camera = 0;
    state_.fovDegrees = glm::degrees(rig_.hand().camera().verticalFov);
    startAnew();
}

/// Turns the camera towards the point that is seen there.
void RenderLoop::focus(const std::array<float, 2>& position) {
    const gpu::Extent extent = wanted_.extent;
    if (extent.width == 0 || extent.height == 0) return;
    std::optional<scene::SceneFrame> moved;
    if (blurOfLast_.isOpen()) moved = stage_->standAt(playback_.time());
    const auto point =
        picker_.pointSeen(stage_->onDevice(), moved, cameraNow(), extent, pixelAt(position[0], extent.width),
                          pixelAt(position[1], extent.height));
    if (!point) return;
    freeCamera();
    rig_.hand().focus(*point);
}

/// Updates the pose in the state.
void RenderLoop::showPose() {
    const scene::Camera camera = rig_.at(*stage_, playback_.time());
    state_.halfHeight = camera.orthographic ? camera.halfHeight : 0.0f;
    if (rig_.isFree()) {
        state_.pose = {rig_.hand().eye(), rig_.hand().target(), rig_.hand().up()};
        return;
    }
    const vec3 eye(camera.toWorld[3]);
    state_.pose = {eye, eye - rig_.hand().distance() * vec3(camera.toWorld[2]), vec3(camera.toWorld[1])};
}

/// Places the camera at the state's pose. An invalid pose changes nothing.
void RenderLoop::placeCamera() {
    const bool wasFree = rig_.isFree();
    rig_.place(*stage_, playback_.time(), state_.pose.eye, state_.pose.target, state_.pose.up);
    state_.camera = rig_.chosen();
    if (wasFree) return;
    state_.fovDegrees = glm::degrees(rig_.hand().camera().verticalFov);
    startAnew();
}

/// Returns true if it has filled Facts::allValues. Waits for a frame that tells about histories, too, unless
/// rendering is stopped.
bool RenderLoop::answerProbe() {
    if (!probeAt_ || !main_ || isNew_ || (state_.running && main_.lacksReasons())) return false;
    const std::array<float, 2> position = *std::exchange(probeAt_, std::nullopt);
    attempt([&] {
        facts_.allValues = probeAll(position);
        facts_.probedAt = position;
    });
    return true;
}

std::string RenderLoop::probeAll(const std::array<float, 2>& position) {
    const gpu::Extent extent = wanted_.extent;
    const auto valuesAt = [&](const image::Image& picture) {
        std::string text;
        const uint32_t x = pixelAt(position[0], picture.width), y = pixelAt(position[1], picture.height);
        if (gpu::Extent{picture.width, picture.height} != extent) text = fmt::format(" ({}, {})", x, y);
        text += ":";
        for (uint32_t c = 0; c < picture.components; ++c) text += fmt::format(" {:.5g}", picture.at(x, y, c));
        return text;
    };
    std::string text = fmt::format("pixel ({}, {})\n", pixelAt(position[0], extent.width),
                                   pixelAt(position[1], extent.height));
    if (const std::string history = historyText(main_.renderer().historyReasons(), position);
        !history.empty())
        text += history + "\n";
    std::vector<std::string> seen;
    for (const gpu::RecordedPass& pass : main_.renderer().graph().passes()) {
        if (main_.renderer().graph().imagesWrittenBy(pass.name).empty()) continue;
        for (const auto& [name, picture] : main_.renderer().dump(pass.name)) {
            if (std::ranges::find(seen, name) != seen.end()) continue;
            seen.push_back(name);
            text += name + valuesAt(picture) + "\n";
        }
    }
    return text;
}

/// Derives settings from others, and restores the previous value of impossible ones.
void RenderLoop::applySettings() {
    rig_.hand().setVerticalFov(glm::radians(state_.fovDegrees));
    stage_->setLights(state_.lights.lights);
    playback_.playing = state_.playing && (stage_->moves() || rig_.movesOnPath());
    facts_.duration = rig_.movesOnPath() || stage_->moves() ? rig_.duration(*stage_) : 0.0;
    if (facts_.duration > 0.0 && playback_.time() > facts_.duration) playback_.seek(0.0);
    state_.time = static_cast<float>(playback_.time());
    showPose();
    provideNetworks();
    noteActivity();
    if (!state_.comparison.isOn()) comparison_.drop();
}

/// Begins to load the networks that the pipelines need. Until they are there, the method before is rendered,
/// and the comparison waits.
void RenderLoop::provideNetworks() {
    finishNetworks();
    const denoise::DenoiserSettings& denoisers = state_.render.denoisers;
    Pipeline& chosen = state_.render.pipeline;
    const Pipeline compared = settingsOfComparison(state_, state_.render, networks_).pipeline;
    if (networks_.lacks(chosen, denoisers))
        networks_.begin(chosen, denoisers);
    else if (state_.comparison.isOn() && networks_.lacks(compared, denoisers))
        networks_.begin(compared, denoisers);
    else if (networks_.isLoading())
        networks_.cancel();
    // A given number of frames is for scripts, which want the same pictures each time.
    if (networks_.isLoading() && (settings_.quitAfter > 0 || ending_)) {
        networks_.wait();
        finishNetworks();
    }
    if (networks_.canRender(chosen)) withNetworks_ = chosen;
    wanted_ = state_.render;
    wanted_.pipeline = withNetworks_;
    wanted_.jitter =
        state_.jitter > 0 ? static_cast<Jitter>(state_.jitter - 1) : defaultJitter(wanted_.pipeline);
    state_.render.jitter = wanted_.jitter;
    wanted_ = withParts(wanted_, state_.parts);
    networks_.set(wanted_);
    comparison_.setWaiting(!networks_.canRender(compared));
}

/// Takes the network over that was being loaded. If that failed, goes back to what needs none.
void RenderLoop::finishNetworks() {
    if (!networks_.isDone()) return;
    changedFacts_ = true;
    if (!attempt([&] { networks_.take(); })) doWithoutNetworks();
}

/// Pipelines that lack a network are no longer wanted.
void RenderLoop::doWithoutNetworks() {
    if (!networks_.canRender(state_.render.pipeline)) state_.render.pipeline = withNetworks_;
    if (state_.comparison.isOn() &&
        !networks_.canRender(settingsOfComparison(state_, state_.render, networks_).pipeline))
        state_.comparison.with = 0;
}

void RenderLoop::cancelLoading() {
    if (!loading_ && !networks_.isLoading()) return;
    if (loading_) {
        loading_.cancel();
        state_.lights.showBackground(settings_.source);
    } else {
        networks_.settle();
        doWithoutNetworks();
    }
    say("cancelled");
}

}  // namespace limpid::studio
