#include "viewer/start/start_page.h"

#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "scene/builtin/builtin.h"
#include "viewer/looks/theme.h"
#include "viewer/panel/actions.h"
#include "viewer/panel/fields.h"

namespace limpid::viewer {
namespace {

/// A picture with its name below. Returns true if it was clicked.
bool drawCard(const Drawing& with, const std::string& name, const Thumbnails::Place& place, float width) {
    const ImVec2 size{width, std::round(width * place.size.y / place.size.x)};
    ImGui::BeginGroup();
    const bool clicked = ImGui::InvisibleButton(name.c_str(), {size.x, size.y + 1.6f * ImGui::GetFontSize()});
    const bool hovered = ImGui::IsItemHovered();
    const ImVec2 low = ImGui::GetItemRectMin();
    with.controls.note(name);
    ImDrawList& draws = *ImGui::GetWindowDrawList();
    draws.AddImage(ImGui::GetIO().Fonts->TexID, low, {low.x + size.x, low.y + size.y}, place.from, place.to);
    if (hovered)
        draws.AddRect({low.x - 2, low.y - 2}, {low.x + size.x + 2, low.y + size.y + 2},
                      ImGui::GetColorU32(ImGuiCol_SliderGrab), 3.0f, 0, 2.0f);
    draws.AddText({low.x, low.y + size.y + 0.2f * ImGui::GetFontSize()}, ImGui::GetColorU32(ImGuiCol_Text),
                  name.c_str());
    ImGui::EndGroup();
    return clicked;
}

/// Scenes without a picture: all of them, if the program was copied without its pictures.
void drawOthers(const Drawing& with, const Thumbnails& thumbnails) {
    for (const scene::BuiltinInfo& info : scene::builtinScenes()) {
        if (thumbnails.places().contains(info.name)) continue;
        if (with.controls.button(info.name.c_str())) askToOpen(with, "builtin:" + info.name);
        if (ImGui::IsItemHovered()) explain(info.help);
        ImGui::SameLine();
        const float width = ImGui::GetContentRegionAvail().x;
        if (width < 8.0f * ImGui::GetFontSize()) ImGui::NewLine();
    }
    ImGui::NewLine();
}

void drawScenes(const Drawing& with, const Thumbnails& thumbnails) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float gap = 2.0f * style.ItemSpacing.x, whole = ImGui::GetContentRegionAvail().x;
    const float nominal = 12.0f * ImGui::GetFontSize();
    const int columns = std::max(static_cast<int>((whole + gap) / (nominal + gap)), 1);
    const float width = std::floor(std::min(
        (whole - gap * static_cast<float>(columns - 1)) / static_cast<float>(columns), 1.3f * nominal));
    with.controls.setGroup("start");
    int column = 0;
    for (const scene::BuiltinInfo& info : scene::builtinScenes()) {
        const auto found = thumbnails.places().find(info.name);
        if (found == thumbnails.places().end()) continue;
        if (column > 0) ImGui::SameLine(0.0f, gap);
        if (drawCard(with, info.name, found->second, width)) askToOpen(with, "builtin:" + info.name);
        if (ImGui::IsItemHovered()) explain(info.help);
        column = (column + 1) % columns;
    }
    drawOthers(with, thumbnails);
    with.controls.setGroup("");
}

void drawRecent(const Drawing& with) {
    if (with.panel.memory.recent.empty()) return;
    ImGui::Dummy({1.0f, ImGui::GetFontSize()});
    ImGui::TextDisabled("Recent");
    with.controls.setGroup("recent");
    for (const std::string& file : with.panel.memory.recent) {
        if (ImGui::Selectable(file.c_str())) askToOpen(with, file);
        with.controls.note(std::filesystem::path(file).filename().string());
    }
    with.controls.setGroup("");
}

}  // namespace

void drawStartPage(const Drawing& with, const Thumbnails& thumbnails) {
    const Area& area = with.panel.area;
    ImGui::SetNextWindowPos({area.left, area.top});
    ImGui::SetNextWindowSize({area.width, area.height});
    const float margin = std::min(2.5f * ImGui::GetFontSize(), 0.1f * area.width);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, accentsOf(with.panel.memory.dark).stage);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {margin, margin});
    ImGui::Begin("start", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PopStyleVar();
    if (!with.facts.activity.empty()) {
        ImGui::TextUnformatted(with.facts.activityText().c_str());
        if (with.controls.button("cancel"))
            with.panel.asked.push_back({.kind = studio::Request::Kind::CancelLoading});
    } else {
        ImGui::TextUnformatted("Drop a scene here (.gltf, .glb or .obj), or open one of these.");
        ImGui::TextDisabled("? lists keys and mouse.");
        ImGui::Dummy({1.0f, 0.6f * ImGui::GetFontSize()});
        drawScenes(with, thumbnails);
        drawRecent(with);
    }
    ImGui::End();
    ImGui::PopStyleColor();
}

}  // namespace limpid::viewer
