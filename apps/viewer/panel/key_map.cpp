#include "viewer/panel/key_map.h"

#include <imgui.h>

#include <utility>

namespace limpid::viewer {
namespace {

constexpr std::pair<const char*, const char*> keys[] = {
    {"left button", "orbit: the scene follows the mouse"},
    {"double click", "turn to the point under the mouse, and orbit around it"},
    {"right button", "look around; with W, A, S, D, Q, E fly; the wheel sets the speed"},
    {"middle button", "pan"},
    {"wheel", "move towards or away from the point of interest"},
    {"", ""},
    {"Space", "run or pause rendering"},
    {"V", "preview: a fast picture for finding one's way"},
    {"P", "values of all images under the mouse, marked by a cross; at the same pixel: hide them"},
    {"Tab", "hide or show the panel"},
    {"", ""},
    {"Ctrl+Z, Ctrl+Shift+Z or Ctrl+Y", "undo, redo"},
    {"Ctrl+F", "search all settings"},
    {"Ctrl and a click", "on a slider: type a number"},
    {"?", "this list"},
    {"Escape", "close what is open; quit"},
};

}  // namespace

void drawKeyMap(Controls& controls) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * window.x, 0.5f * window.y}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, window);  // longer lists can be scrolled
    ImGui::SetNextWindowFocus();
    ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_PopupBg));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {1.4f * ImGui::GetFontSize(), ImGui::GetFontSize()});
    ImGui::Begin("keys", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav);
    ImGui::TextDisabled("Keys and mouse");
    ImGui::Dummy({1.0f, 0.3f * ImGui::GetFontSize()});
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (const auto& [key, action] : keys) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(key);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(action);
        }
        ImGui::EndTable();
    }
    const ImVec2 low = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    controls.note("key map", "open", low.x, low.y, low.x + size.x, low.y + size.y);
    ImGui::End();
    ImGui::PopStyleVar(3);
    ImGui::PopStyleColor();
}

}  // namespace limpid::viewer
