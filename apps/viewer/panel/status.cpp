#include "viewer/panel/status.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>

#include "viewer/looks/theme.h"

namespace limpid::viewer {
namespace {

using studio::Facts;
using studio::Request;

void drawText(ImU32 color, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
}

const char* frameText(const Facts& facts) {
    return facts.compiling ? "compiling shaders" : facts.computing ? "computing" : "finished";
}

/// What takes longer than a frame, or how far the picture is.
void drawActivity(const Drawing& with) {
    const Facts& facts = with.facts;
    if (!facts.activity.empty()) {
        ImGui::TextUnformatted(facts.activityText().c_str());
        ImGui::SameLine();
        if (with.controls.button("cancel"))
            with.panel.asked.push_back({.kind = Request::Kind::CancelLoading});
        return;
    }
    if (facts.scenesShown == 0) return ImGui::TextUnformatted("no scene");
    std::string text = with.panel.state.running ? frameText(facts) : "paused";
    if (facts.samplesInMean > 0)
        text += fmt::format(": {} of {} samples", facts.samplesInMean, with.panel.state.maxSamples);
    else
        text += fmt::format(": frame {}", facts.frames);
    ImGui::TextUnformatted(text.c_str());
}

}  // namespace

void drawStatus(const Drawing& with) {
    const Facts& facts = with.facts;
    const Accents colors = accentsOf(with.panel.memory.dark);
    const float start = ImGui::GetCursorPosY();
    drawActivity(with);
    with.controls.note("status", facts.activity.empty() ? frameText(facts) : facts.activityText());
    const studio::State& state = with.panel.state;
    if (facts.scenesShown > 0)
        drawText(colors.quiet,
                 fmt::format("{}x{}, {} a frame, {}", state.render.extent.width, state.render.extent.height,
                             studio::durationText(facts.timings.frames().last()), facts.device));
    if (!facts.fault.empty()) {
        drawText(colors.fault, facts.fault);
        with.controls.note("error", facts.fault);
    }
    if (!facts.message.empty() && !facts.messageIsOld) ImGui::TextWrapped("%s", facts.message.c_str());
    if (!facts.allValues.empty()) ImGui::TextUnformatted(facts.allValues.c_str());
    with.panel.statusHeight = ImGui::GetCursorPosY() - start;
}

}  // namespace limpid::viewer
