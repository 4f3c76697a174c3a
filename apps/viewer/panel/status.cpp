#include "viewer/panel/status.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>

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

constexpr double longFrame = 1.0;  ///< seconds, after which it is told how long a frame takes

/// Seconds for which the frame that is being computed takes already; 0: none is.
double secondsOfFrame(const Drawing& with) {
    PanelState& panel = with.panel;
    const Facts& facts = with.facts;
    if (!facts.computing) panel.frameSince.reset();
    const std::array<uint64_t, 2> number{facts.frames, facts.framesBegun};
    if (facts.computing && (!panel.frameSince || panel.frameNumber != number)) {
        panel.frameSince = ImGui::GetTime();
        panel.frameNumber = number;
    }
    return panel.frameSince ? ImGui::GetTime() - *panel.frameSince : 0.0;
}

const char* frameText(const Facts& facts) {
    return facts.compiling ? "compiling shaders" : facts.computing ? "computing" : "finished";
}

/// Of the picture that is shown.
std::string pictureText(const Facts& facts) {
    std::string text;
    if (facts.pictureExtent.width > 0)
        text = fmt::format("{}x{}, ", facts.pictureExtent.width, facts.pictureExtent.height);
    if (const float time = facts.timings.frames().last(); time > 0.0f)
        text += studio::durationText(time) + " a frame, ";
    return text + facts.device;
}

/// What takes longer than a frame, or how far the picture is.
void drawActivity(const Drawing& with) {
    const Facts& facts = with.facts;
    const double seconds = secondsOfFrame(with);
    if (!facts.activity.empty()) {
        ImGui::TextUnformatted(facts.activityText().c_str());
        ImGui::SameLine();
        if (with.controls.button("cancel"))
            with.panel.asked.push_back({.kind = Request::Kind::CancelLoading});
        return;
    }
    if (facts.scenesShown == 0) return ImGui::TextUnformatted("no scene");
    std::string text = with.panel.state.running ? frameText(facts) : "paused";
    if (facts.computing && facts.extent.width > facts.pictureExtent.width)
        text += fmt::format(" {}x{}", facts.extent.width, facts.extent.height);
    if (facts.samplesInMean > 0)
        text += fmt::format(": {} of {} samples", facts.samplesInMean, with.panel.state.maxSamples);
    else
        text += fmt::format(": frame {}", facts.frames);
    if (seconds > longFrame) text += fmt::format(", for {:.0f} s", seconds);
    ImGui::TextUnformatted(text.c_str());
}

}  // namespace

void drawStatus(const Drawing& with) {
    const Facts& facts = with.facts;
    const Accents colors = accentsOf(with.panel.memory.dark);
    const float start = ImGui::GetCursorPosY();
    drawActivity(with);
    with.controls.note("status", facts.activity.empty() ? frameText(facts) : facts.activityText());
    if (facts.scenesShown > 0) drawText(colors.quiet, pictureText(facts));
    if (!facts.fault.empty()) {
        drawText(colors.fault, facts.fault);
        with.controls.note("error", facts.fault);
    }
    if (!facts.message.empty() && !facts.messageIsOld) ImGui::TextWrapped("%s", facts.message.c_str());
    if (!facts.allValues.empty()) ImGui::TextUnformatted(facts.allValues.c_str());
    with.panel.statusHeight = ImGui::GetCursorPosY() - start;
}

}  // namespace limpid::viewer
