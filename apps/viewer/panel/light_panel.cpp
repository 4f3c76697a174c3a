#include "viewer/panel/light_panel.h"

#include <imgui.h>

#include "viewer/panel/fields.h"

namespace limpid::viewer {
namespace {

using scene::LightControl;
using studio::Request;
using Lamp = scene::PunctualLight::Kind;

const Range brightnessRange(0.0, 1e9, {0.0, 100.0, SliderScale::Logarithmic, 0.01});

void drawPlace(LightControl& light, const studio::Facts& facts, Controls& controls) {
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
bool drawLight(LightControl& light, bool added, const studio::Facts& facts, Controls& controls) {
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

}  // namespace

void drawBackground(const Drawing& with) {
    studio::LightDesk& desk = with.panel.state.lights;
    Controls& controls = with.controls;
    controls.toggle("background of its own", desk.hasBackground);
    explainRow(with, "A uniform environment instead of the scene's own; the scene is loaded again");
    if (!desk.hasBackground) return;
    controls.color("background color", desk.background);
    const char* const names[] = {"red", "green", "blue"};
    for (int i = 0; i < 3; ++i) {
        controls.slider(names[i], desk.background[i],
                        {0.0, 1e9, {0.0, 100.0, SliderScale::Logarithmic, 0.01}});
    }
}

void drawLightList(const Drawing& with) {
    studio::LightDesk& desk = with.panel.state.lights;
    ImGui::PushID("lights");
    for (LightControl& light : desk.lights) {
        if (drawLight(light, desk.isAdded(light), with.facts, with.controls))
            with.panel.asked.push_back({.kind = Request::Kind::RemoveLamp, .index = light.index});
    }
    ImGui::PopID();
    with.controls.setGroup("light");
}

}  // namespace limpid::viewer
