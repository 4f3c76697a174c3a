#include "viewer/sections/passes.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "base/text/bytes_text.h"
#include "viewer/looks/legends.h"
#include "viewer/panel/fields.h"

namespace limpid::viewer {
namespace {

using studio::Facts;
using studio::PassTrack;
using studio::Track;

constexpr double previewDelay = 0.15;  ///< seconds; a pointer that only passes by shows nothing

/// The pass that a click has chosen; empty: the picture.
std::string chosenPass(const PanelState& panel) {
    return panel.passPreview.shown ? panel.passPreview.usually : panel.state.pass;
}

/// Ends the preview: after a click on the chosen pass, the picture is shown although the pointer is there.
void choosePass(PanelState& panel, const std::string& pass) {
    panel.state.pass = pass;
    panel.passPreview.shown = false;
    panel.passPreview.clicked = true;
}

/// `pass`: the one under the pointer; empty: none.
void preview(PanelState& panel, const std::string& pass) {
    PassPreview& now = panel.passPreview;
    if (pass != now.pass) {
        now.pass = pass;
        now.since = ImGui::GetTime();
        now.clicked = false;
    }
    if (pass.empty()) return endPassPreview(panel);
    if (now.clicked || (!now.shown && ImGui::GetTime() - now.since < previewDelay)) return;
    if (!std::exchange(now.shown, true)) now.usually = panel.state.pass;
    panel.state.pass = pass;
}

/// Draws the controls for the pass that is chosen in the list. For a preview the list must not move.
void drawInspector(const Drawing& with) {
    if (chosenPass(with.panel).empty() || with.facts.images.empty()) return;
    beginRows();
    for (const char* key : {"image", "view.channels", "view.stops", "view.false_color"}) drawField(with, key);
    if (with.panel.state.view.falseColor) drawColormapLegend(with.controls, with.panel.state.view.stops);
    endRows();
    ImGui::TextUnformatted(with.panel.probe.c_str());
    ImGui::TextWrapped("%s", with.panel.reasons.c_str());
}

void plot(const char* name, const Track& track, ImVec2 size, const char* text = nullptr) {
    const float largest = track.values().empty() ? 1.0f : *std::ranges::max_element(track.values());
    ImGui::PlotLines(name, track.values().data(), static_cast<int>(track.values().size()), 0, text, 0.0f,
                     1.1f * largest, size);
}

/// The way back from a pass that was chosen.
void drawPictureRow(const Drawing& with) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    if (ImGui::Selectable("the picture", chosenPass(with.panel).empty(), ImGuiSelectableFlags_SpanAllColumns))
        choosePass(with.panel, "");
    with.controls.note("pass none");
}

void drawSums(const Drawing& with) {
    const Facts& facts = with.facts;
    const std::string last = studio::durationText(facts.timings.frames().last()) + " a frame";
    plot("##frames", facts.timings.frames(),
         {ImGui::GetContentRegionAvail().x, 3.0f * ImGui::GetTextLineHeight()}, last.c_str());
    with.controls.note("frame times", last);
    const std::string memory = fmt::format("memory {}, of it the scene's {}", bytesText(facts.memoryBytes),
                                           bytesText(facts.sceneBytes));
    ImGui::TextUnformatted(memory.c_str());
    with.controls.note("memory", memory);
}

}  // namespace

void endPassPreview(PanelState& panel) {
    if (panel.passPreview.shown) panel.state.pass = panel.passPreview.usually;
    panel.passPreview = {};
}

void drawPasses(const Drawing& with) {
    PanelState& panel = with.panel;
    std::string pointedAt;
    drawInspector(with);
    drawSums(with);
    if (!ImGui::BeginTable("passes", 3, ImGuiTableFlags_RowBg)) return;
    const float graphWidth = 5.0f * ImGui::GetFontSize();
    ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("graph", ImGuiTableColumnFlags_WidthFixed, graphWidth);
    ImGui::TableSetupColumn("time", ImGuiTableColumnFlags_WidthFixed, 5.0f * ImGui::GetFontSize());
    drawPictureRow(with);
    for (const PassTrack& pass : with.facts.timings.passes()) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const bool chosen = pass.name == chosenPass(panel);
        if (ImGui::Selectable(pass.name.c_str(), chosen,
                              ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowItemOverlap))
            choosePass(panel, chosen ? std::string() : pass.name);
        if (ImGui::IsItemHovered()) pointedAt = pass.name;
        with.controls.note("pass " + pass.name);
        ImGui::TableNextColumn();
        plot(("##" + pass.name).c_str(), pass.milliseconds, {graphWidth, ImGui::GetTextLineHeight()});
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(studio::durationText(pass.milliseconds.last()).c_str());
    }
    ImGui::EndTable();
    preview(panel, pointedAt);
    with.controls.note("pass shown", panel.state.pass);
}

}  // namespace limpid::viewer
