#include "viewer/panel/passes.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "base/text/bytes_text.h"
#include "viewer/panel/fields.h"

namespace limpid::viewer {
namespace {

using studio::Facts;
using studio::PassTrack;
using studio::State;
using studio::Track;

/// Draws the controls for the pass that is selected in the list.
void drawInspector(const Drawing& with) {
    if (with.panel.state.pass.empty() || with.facts.images.empty()) return;
    beginRows();
    for (const char* key : {"image", "view.channels", "view.stops", "view.false_color"}) drawField(with, key);
    endRows();
    ImGui::TextUnformatted(with.panel.probe.c_str());
    ImGui::TextWrapped("%s", with.panel.reasons.c_str());
}

void plot(const char* name, const Track& track, ImVec2 size, const char* text = nullptr) {
    const float largest = track.values().empty() ? 1.0f : *std::ranges::max_element(track.values());
    ImGui::PlotLines(name, track.values().data(), static_cast<int>(track.values().size()), 0, text, 0.0f,
                     1.1f * largest, size);
}

void drawSums(const Drawing& with) {
    const Facts& facts = with.facts;
    const std::string last = fmt::format("{:.1f} ms a frame", facts.timings.frames().last());
    plot("##frames", facts.timings.frames(),
         {ImGui::GetContentRegionAvail().x, 3.0f * ImGui::GetTextLineHeight()}, last.c_str());
    with.controls.note("frame times", last);
    const std::string memory = fmt::format("memory {}, of it the scene's {}", bytesText(facts.memoryBytes),
                                           bytesText(facts.sceneBytes));
    ImGui::TextUnformatted(memory.c_str());
    with.controls.note("memory", memory);
}

}  // namespace

void drawPasses(const Drawing& with) {
    State& state = with.panel.state;
    drawInspector(with);
    drawSums(with);
    if (!ImGui::BeginTable("passes", 3, ImGuiTableFlags_RowBg)) return;
    const float graphWidth = 5.0f * ImGui::GetFontSize();
    ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("graph", ImGuiTableColumnFlags_WidthFixed, graphWidth);
    ImGui::TableSetupColumn("time", ImGuiTableColumnFlags_WidthFixed, 5.0f * ImGui::GetFontSize());
    for (const PassTrack& pass : with.facts.timings.passes()) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        if (ImGui::Selectable(pass.name.c_str(), pass.name == state.pass,
                              ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowItemOverlap))
            state.pass = pass.name == state.pass ? std::string() : pass.name;
        with.controls.note("pass " + pass.name);
        ImGui::TableNextColumn();
        plot(("##" + pass.name).c_str(), pass.milliseconds, {graphWidth, ImGui::GetTextLineHeight()});
        ImGui::TableNextColumn();
        ImGui::Text("%.3f ms", static_cast<double>(pass.milliseconds.last()));
    }
    ImGui::EndTable();
}

}  // namespace limpid::viewer
