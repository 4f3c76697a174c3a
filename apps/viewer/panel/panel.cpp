#include "viewer/panel/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "studio/state/state_json.h"
#include "viewer/panel/actions.h"
#include "viewer/panel/fields.h"
#include "viewer/panel/status.h"
#include "viewer/sections/search.h"
#include "viewer/sections/sections.h"

namespace limpid::viewer {
namespace {

constexpr float narrowestPanel = 220.0f, narrowestPicture = 64.0f;  ///< at a scale of 1
constexpr float edgeWidth = 7.0f;                                   ///< of what the mouse can grip
constexpr float largestStatus = 0.4f;                               ///< share of the panel's height
constexpr float usualStatus = 4.0f;   ///< lines; shorter messages come and go without moving the sections
constexpr float largestShare = 0.5f;  ///< of the window's width, that a panel takes which nobody has dragged
constexpr ImGuiWindowFlags fixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                                   ImGuiWindowFlags_NoScrollWithMouse;

/// The panel's edge, which can be dragged.
void drawEdge(const Drawing& with, float height, float scale) {
    // It lies in the padding, which ImGui clips.
    const ImVec2 corner = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    ImGui::PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, false);
    ImGui::SetCursorPos({0.0f, 0.0f});
    ImGui::InvisibleButton("##edge", {std::round(edgeWidth * scale), std::max(height, 1.0f)});
    with.controls.note("panel edge");
    const bool held = ImGui::IsItemActive();
    if (held || ImGui::IsItemHovered()) {
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
        const ImVec2 low = ImGui::GetItemRectMin();
        ImGui::GetWindowDrawList()->AddRectFilled(
            low, {low.x + 2.0f * scale, low.y + height},
            ImGui::GetColorU32(held ? ImGuiCol_SeparatorActive : ImGuiCol_SeparatorHovered));
    }
    ImGui::PopClipRect();
    if (!held) return;
    const float whole = ImGui::GetIO().DisplaySize.x;
    const float most = std::max(whole - narrowestPicture * scale, narrowestPanel * scale);
    with.panel.memory.panelWidth =
        std::round(std::clamp(whole - ImGui::GetIO().MousePos.x, narrowestPanel * scale, most));
}

bool bigButton(const Drawing& with, const char* text, const char* noted, const std::string& value,
               const char* help) {
    const bool pressed = ImGui::Button(text);
    with.controls.note(noted, value);
    if (ImGui::IsItemHovered()) explain(help);
    return pressed;
}

void drawRun(const Drawing& with) {
    studio::State& state = with.panel.state;
    if (bigButton(with, state.running ? "pause" : "run", "running", state.running ? "on" : "off",
                  "Frames are rendered as long as they improve the picture (Space)"))
        state.running = !state.running;
    if (with.facts.duration > 0.0) {
        const char* const text = state.playing ? "stop clip" : "play clip";
        sameLineFor(text);
        if (bigButton(with, text, "play", state.playing ? "on" : "off",
                      "The scene's animation, or the camera's path"))
            state.playing = !state.playing;
    }
    for (const Action& action : actions()) {
        if (std::string_view(action.section) != "time") continue;
        sameLineFor(action.name);
        if (bigButton(with, action.name, action.name, "", action.help)) ask(with, action.kind);
    }
}

void drawHistory(const Drawing& with) {
    PanelState& panel = with.panel;
    ImGui::BeginDisabled(!panel.history.canUndo());
    if (bigButton(with, "undo", "undo", "", "Takes back the last change (Ctrl+Z)")) undo(panel);
    ImGui::EndDisabled();
    sameLineFor("redo");
    ImGui::BeginDisabled(!panel.history.canRedo());
    if (bigButton(with, "redo", "redo", "", "Makes the change again (Ctrl+Shift+Z, Ctrl+Y)")) redo(panel);
    ImGui::EndDisabled();
}

void drawBar(const Drawing& with) {
    PanelState& panel = with.panel;
    drawRun(with);
    sameLineFor("undo");
    drawHistory(with);
    sameLineFor("?");
    if (bigButton(with, "?", "keys", "", "Keys and mouse (?)")) panel.showsKeys = !panel.showsKeys;
    if (std::exchange(panel.focusesSearch, false)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1.0f);
    with.controls.text("search", "search settings (Ctrl+F)", panel.search);
}

/// The sections, or what was searched for, above the status.
void drawContent(const Drawing& with) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float left = ImGui::GetContentRegionAvail().y;
    const float usual = usualStatus * ImGui::GetTextLineHeightWithSpacing();
    const float status =
        std::min(std::max(with.panel.statusHeight, usual) + style.ItemSpacing.y, largestStatus * left);
    ImGui::BeginChild("sections", {0.0f, std::max(left - status - 2.0f * style.ItemSpacing.y, 1.0f)});
    const ImVec2 low = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    with.controls.note("panel", "", low.x, low.y, low.x + size.x, low.y + size.y);
    if (with.panel.search.empty())
        drawSections(with);
    else
        drawFound(with);
    ImGui::EndChild();
    ImGui::Separator();
    ImGui::BeginChild("status");
    drawStatus(with);
    ImGui::EndChild();
}

void step(PanelState& panel, const std::optional<nlohmann::json>& changes) {
    if (!changes) return;
    panel.steps = true;
    for (const auto& [key, value] : changes->items()) {
        try {
            studio::apply(panel.state, {{key, value}});
        } catch (const Error&) {  // it no longer fits: another scene has other lights
        }
    }
}

}  // namespace

float panelWidthBeside(float picture) {
    return std::clamp(picture, narrowestPanel, usualPanelWidth);
}

Area pictureArea(const PanelState& panel, float width, float height, float scale) {
    const float usual =
        std::min(usualPanelWidth * scale, std::max(largestShare * width, narrowestPanel * scale));
    const float wanted = panel.memory.panelWidth > 0.0f ? panel.memory.panelWidth : std::round(usual);
    const float free = std::min(wanted, width - narrowestPicture * scale);
    const bool fits = panel.shown && free >= std::min(narrowestPanel * scale, wanted);
    return {0.0f, 0.0f, fits ? width - free : width, height};
}

void drawPanel(const Drawing& with, float scale) {
    const Area& area = with.panel.area;
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    with.panel.holdsPose = false;
    if (area.width >= window.x) return;
    ImGui::SetNextWindowPos({area.left + area.width, 0.0f});
    ImGui::SetNextWindowSize({window.x - area.width, window.y});
    ImGui::Begin("Limpid", nullptr, fixed | ImGuiWindowFlags_NoBringToFrontOnFocus);
    const ImVec2 start = ImGui::GetCursorPos();
    drawEdge(with, window.y, scale);
    ImGui::SetCursorPos(start);
    drawBar(with);
    drawContent(with);
    ImGui::End();
}

void undo(PanelState& panel) {
    step(panel, panel.history.undo());
}

void redo(PanelState& panel) {
    step(panel, panel.history.redo());
}

}  // namespace limpid::viewer
