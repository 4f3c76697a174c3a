#include "viewer/panel/light_panel.h"

#include <imgui.h>

namespace limpid::viewer {
namespace {

using scene::LightControl;
using Lamp = scene::PunctualLight::Kind;

const Range brightnessRange(0.0, 1e9, {0.0, 100.0, SliderScale::Logarithmic, 0.01});

void drawPlace(LightControl& light, const PanelFacts& facts, Controls& controls) {
    if (light.kind == LightControl::Kind::Environment) {
        controls.slider("turn", light.turn, {-360.0, 360.0, {-180.0, 180.0}}, "{:.1f}");
        return;
    }
    if (light.kind != LightControl::Kind::Lamp) return;
    if (light.lamp != Lamp::Directional)
        controls.vector("position", light.position, 0.002f * facts.sceneRadius);
    if (light.lamp == Lamp::Point) return;
    vec3 direction = light.direction;
    if (controls.vector("direction", direction, 0.01f) && glm::length(direction) > 1e-6f)
        light.direction = glm::normalize(direction);
}

/// Returns true if the light is to be removed.
bool drawLight(LightControl& light, bool added, const PanelFacts& facts, Controls& controls) {
    ImGui::PushID(light.index + 1'000'000 * static_cast<int>(light.kind));
    controls.setGroup("light." + light.name);
    controls.checkbox("##on", light.on);
    ImGui::SameLine();
    bool removed = false;
    if (controls.tree(light.name.c_str())) {
        controls.color("color", light.color);
        controls.slider("brightness", light.brightness, brightnessRange);
        drawPlace(light, facts, controls);
        if (added) removed = controls.button("remove");
        ImGui::TreePop();
    }
    ImGui::PopID();
    return removed;
}

void drawBackground(PanelState& state, Controls& controls) {
    LightDesk& desk = state.lights;
    bool& changed = state.asked.relight;
    changed |= controls.checkbox("background of its own", desk.hasBackground);
    if (!desk.hasBackground) return;
    const char* const names[] = {"red", "green", "blue"};
    for (int i = 0; i < 3; ++i) {
        controls.slider(names[i], desk.background[i],
                        {0.0, 1e9, {0.0, 100.0, SliderScale::Logarithmic, 0.01}});
        changed |= ImGui::IsItemDeactivatedAfterEdit();
    }
}

}  // namespace

void drawLights(PanelState& state, const PanelFacts& facts, Controls& controls) {
    controls.setGroup("");
    if (!controls.header("light")) return;
    controls.setGroup("light");
    PanelRequests& asked = state.asked;
    asked.addPoint |= controls.button("add a point");
    ImGui::SameLine();
    asked.addSun |= controls.button("add a sun");
    ImGui::SameLine();
    if (controls.button("as loaded")) state.lights.reset();
    ImGui::SameLine();
    asked.saveLights |= controls.button("save lights");
    for (LightControl& light : state.lights.lights) {
        if (drawLight(light, state.lights.isAdded(light), facts, controls)) asked.removeLamp = light.index;
    }
    controls.setGroup("light");
    drawBackground(state, controls);
    controls.setGroup("");
}

}  // namespace limpid::viewer
