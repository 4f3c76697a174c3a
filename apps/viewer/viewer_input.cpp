// Input to the window: keys, mouse, the camera, and the panel's requests and settings.
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "scene/framing/framing.h"
#include "viewer/camera/steering.h"
#include "viewer/compare/picture_files.h"
#include "viewer_session.h"

namespace limpid::viewer {
void Viewer::handleInput(double seconds) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto pressed = [&](int key) { return !io.WantTextInput && ImGui::IsKeyPressed(key, false); };
    if (pressed(GLFW_KEY_ESCAPE)) window_.close();
    if (pressed(GLFW_KEY_TAB)) panel_.shown = !panel_.shown;
    if (pressed(GLFW_KEY_SPACE)) panel_.running = !panel_.running;
    if (pressed(GLFW_KEY_P)) panel_.asked.probe = true;
    if (pressed(GLFW_KEY_V)) panel_.setPreview(!panel_.isPreview());
    const bool divides = display_.dragsDivider(panel_, controls_);
    if (!io.WantCaptureMouse && !divides) fly(static_cast<float>(seconds));
}

void Viewer::fly(float seconds) {
    const Steering steering = Steering::now();
    if ((steering.moves() || display_.clickedTwice()) && !rig_.isFree()) {
        rig_.setFree(*stage_, playback_.time());
        panel_.fovDegrees = glm::degrees(rig_.hand().camera().verticalFov);
        startAnew();
    }
    panel_.camera = rig_.chosen();
    if (display_.clickedTwice()) attempt([&] { focus(); });
    steering.apply(rig_.hand(), seconds, speed_);
}

/// Turns the camera towards the point under the mouse.
void Viewer::focus() {
    const gpu::Extent extent = panel_.render.extent;
    if (extent.width == 0 || extent.height == 0) return;
    const auto [x, y] = display_.pixelUnderMouse(extent);
    if (const auto point = picker_.pointSeen(stage_->onDevice(), cameraNow(), extent, x, y))
        rig_.hand().focus(*point);
}

/// Updates the pose in the panel.
void Viewer::showPose() {
    // The camera normalises `up`. Showing that at once would disturb the user's typing.
    if (panel_.holdsPose) return;
    if (rig_.isFree()) {
        panel_.pose = {rig_.hand().eye(), rig_.hand().target(), rig_.hand().up()};
        return;
    }
    const scene::Camera camera = rig_.at(*stage_, playback_.time());
    const vec3 eye(camera.toWorld[3]);
    panel_.pose = {eye, eye - rig_.hand().distance() * vec3(camera.toWorld[2]), vec3(camera.toWorld[1])};
}

/// Places the camera at the panel's pose. An invalid pose changes nothing.
void Viewer::placeCamera() {
    const bool wasFree = rig_.isFree();
    rig_.place(*stage_, playback_.time(), panel_.pose.eye, panel_.pose.target, panel_.pose.up);
    panel_.camera = rig_.chosen();
    if (wasFree) return;
    panel_.fovDegrees = glm::degrees(rig_.hand().camera().verticalFov);
    startAnew();
}

/// Carries out the panel's requests.
void Viewer::applyRequests() {
    PanelRequests& asked = panel_.asked;
    if (std::exchange(asked.open, false)) attempt([&] { open(panel_.file, Arrival::Named); });
    for (const std::string& file : window_.takeDropped()) attempt([&] { open(file, Arrival::Dropped); });
    applyLightRequests();
    if (std::exchange(asked.resetCamera, false)) {
        panel_.camera = 0;
        panel_.fovDegrees = glm::degrees(rig_.home().verticalFov);
        asked.choosePose = true;
    }
    if (std::exchange(asked.choosePose, false)) {
        rig_.choose(*stage_, panel_.camera);
        panel_.playing |= rig_.movesOnPath();
        asked.reset = true;
    }
    if (std::exchange(asked.place, false)) placeCamera();
    if (std::exchange(asked.seeAll, false)) {
        rig_.stand(*stage_, scene::frameScene(stage_->scene()));
        panel_.camera = 0;
        panel_.fovDegrees = glm::degrees(rig_.hand().camera().verticalFov);
        asked.reset = true;
    }
    if (std::exchange(asked.seek, false)) playback_.seek(double{panel_.time});
    if (std::exchange(asked.reset, false)) startAnew();
    measureExposure();
    if (std::exchange(asked.probe, false) && main_)
        facts_.allValues = facts_.allValues.empty() ? display_.probeAll(main_) : std::string();
    if (std::exchange(asked.command, false)) attempt([&] { copyCommand(); });
    if (std::exchange(asked.saveLights, false)) attempt([&] { saveLights(); });
    if (std::exchange(asked.savePath, false)) attempt([&] { savePath(); });
    if (std::exchange(asked.screenshot, false) && main_) attempt([&] { save(unusedFile("limpid", ".png")); });
    if (std::exchange(asked.exr, false) && main_) attempt([&] { save(unusedFile("limpid", ".exr")); });
}

/// Derives settings from others, and restores the previous value of impossible ones.
void Viewer::applySettings() {
    const gpu::Extent window = window_.pixels();
    RenderSettings& render = panel_.render;
    const auto shrunk = [&](uint32_t pixels) {
        return pixels == 0 ? 0 : std::max(pixels >> panel_.shrink, 1u);
    };
    render.extent = {shrunk(window.width), shrunk(window.height)};
    if (panel_.jitter > 0)
        render.jitter = static_cast<Jitter>(panel_.jitter - 1);
    else
        render.jitter = defaultJitter(render.pipeline);
    rig_.hand().setVerticalFov(glm::radians(panel_.fovDegrees));
    stage_->setLights(panel_.lights.lights);
    playback_.playing = panel_.playing && (stage_->moves() || rig_.movesOnPath());
    facts_.duration = rig_.movesOnPath() || stage_->moves() ? rig_.duration(*stage_) : 0.0;
    if (facts_.duration > 0.0 && playback_.time() > facts_.duration) playback_.seek(0.0);
    panel_.time = static_cast<float>(playback_.time());
    loadNetworks();
    if (!panel_.comparison.isOn()) comparison_.drop();
}

/// Loads the networks that the pipelines need. If that fails, goes back to a pipeline without one.
void Viewer::loadNetworks() {
    RenderSettings& render = panel_.render;
    const auto have = [&](const Pipeline& pipeline) {
        return !networks_.lacks(pipeline, render.denoisers) ||
               attempt([&] { networks_.load(pipeline, render.denoisers); });
    };
    if (!have(render.pipeline)) render.pipeline = main_.settings().pipeline;
    networks_.set(render);
    if (panel_.comparison.isOn() && !have(settingsOfComparison(panel_, networks_).pipeline))
        panel_.comparison.with = 0;
}

}  // namespace limpid::viewer
