#include "panel.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <map>

#include "renderer/parameters.h"

namespace limpid::viewer {
namespace {

/// Whether the user changed it.
bool editValue(Controls& controls, const ParamInfo& info, ParamValue& value) {
    const char* const name = info.name.c_str();
    if (bool* const on = std::get_if<bool>(&value)) return controls.checkbox(name, *on);
    if (int* const number = std::get_if<int>(&value))
        return controls.slider(name, *number, static_cast<int>(info.minimum), static_cast<int>(info.maximum));
    return controls.slider(name, std::get<float>(value), static_cast<float>(info.minimum),
                           static_cast<float>(info.maximum));
}

void drawGroup(RenderSettings& settings, const ParamGroup& group, Controls& controls) {
    controls.setGroup("");
    if (!controls.header(group.name.c_str())) return;
    controls.setGroup(group.name);
    ImGui::PushID(group.name.c_str());
    for (const ParamPreset& preset : group.presets) {
        if (controls.button(("preset " + preset.name).c_str())) group.applyPreset(settings, preset.name);
        ImGui::SameLine();
    }
    if (controls.button("defaults")) {
        for (const ParamInfo& info : group.infos) group.set(settings, info.name, toString(info.defaultValue));
    }
    for (size_t i = 0; i < group.infos.size(); ++i) {
        const ParamInfo& info = group.infos[i];
        ParamValue value = group.get(settings, i);
        if (editValue(controls, info, value)) group.set(settings, info.name, toString(value));
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%s%s", info.help.c_str(),
                              info.unit.empty() ? "" : (" [" + info.unit + "]").c_str());
    }
    ImGui::PopID();
    controls.setGroup("");
}

void drawPipelines(RenderSettings& settings, Controls& controls) {
    std::vector<std::string> names;
    int chosen = 0;
    for (const Pipeline& pipeline : pipelines()) {
        if (pipeline == settings.pipeline) chosen = static_cast<int>(names.size());
        names.emplace_back(pipeline.name());
    }
    if (controls.choice("pipeline", names, chosen))
        settings.pipeline = pipelines()[static_cast<size_t>(chosen)];
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(settings.pipeline.help()).c_str());
}

/// Of the pass that is chosen in the list.
void drawInspector(PanelState& state, const PanelFacts& facts, Controls& controls) {
    if (state.pass.empty() || facts.images.empty()) return;
    state.image = std::min(state.image, static_cast<int>(facts.images.size()) - 1);
    controls.choice("image", facts.images, state.image);
    controls.choice("channels", {"color", "red", "green", "blue", "alpha"}, state.view.channels);
    controls.slider("brightness, stops", state.view.stops, -16.0f, 16.0f, "%.2f");
    controls.checkbox("false color", state.view.falseColor);
    ImGui::TextUnformatted(facts.probe.c_str());
}

/// A click on one shows its images, another one the picture again.
void drawPasses(PanelState& state, const PanelFacts& facts, Controls& controls) {
    if (!controls.header("passes")) return;
    drawInspector(state, facts, controls);
    std::map<std::string, double> byName;
    std::vector<std::string> order;
    for (const gpu::PassTime& pass : facts.passes) {
        if (byName.emplace(pass.name, 0.0).second) order.push_back(pass.name);
        byName[pass.name] += pass.milliseconds;
    }
    if (!ImGui::BeginTable("passes", 2, ImGuiTableFlags_RowBg)) return;
    for (const std::string& name : order) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        if (ImGui::Selectable(name.c_str(), name == state.pass, ImGuiSelectableFlags_SpanAllColumns))
            state.pass = name == state.pass ? std::string() : name;
        controls.note("pass " + name);
        ImGui::TableNextColumn();
        ImGui::Text("%.3f ms", byName[name]);
    }
    ImGui::EndTable();
}

void drawSampling(PanelState& state, Controls& controls) {
    drawPipelines(state.render, controls);
    int samples = static_cast<int>(state.samples), seed = static_cast<int>(state.render.seed);
    if (controls.slider("samples a frame", samples, 1, 64)) state.samples = static_cast<uint32_t>(samples);
    controls.slider("most samples", state.maxSamples, 1, 1 << 20);
    if (controls.slider("seed", seed, 0, 1000)) state.render.seed = static_cast<uint32_t>(seed);
    controls.choice("jitter", {"as the pipeline needs it", "pixel", "frame", "off"}, state.jitter);
    controls.choice("resolution", {"full", "1/2", "1/4", "1/8"}, state.shrink);
}

void drawDisplay(PanelState& state, Controls& controls) {
    PanelRequests& asked = state.asked;
    controls.slider("exposure, stops", state.exposure, -16.0f, 16.0f, "%.2f");
    asked.measureExposure |= controls.button("measure exposure");
    ImGui::SameLine();
    asked.screenshot |= controls.button("screenshot");
    ImGui::SameLine();
    asked.command |= controls.button("copy command line");
}

void drawTime(PanelState& state, const PanelFacts& facts, Controls& controls) {
    PanelRequests& asked = state.asked;
    controls.checkbox("running", state.running);
    ImGui::SameLine();
    asked.step |= controls.button("step");
    ImGui::SameLine();
    asked.reset |= controls.button("reset");
    if (facts.duration <= 0.0) return;
    ImGui::SameLine();
    controls.checkbox("playing", state.playing);
    asked.seek |= controls.slider("time, s", state.time, 0.0f, static_cast<float>(facts.duration), "%.3f");
}

void drawCamera(PanelState& state, const PanelFacts& facts, Controls& controls) {
    PanelRequests& asked = state.asked;
    asked.choosePose |= controls.choice("camera", facts.cameras, state.camera);
    controls.slider("field of view", state.fovDegrees, 5.0f, 150.0f, "%.1f");
    asked.resetCamera |= controls.button("reset camera");
    ImGui::SameLine();
    asked.savePath |= controls.button("save path flown");
}

void drawOpen(PanelState& state, Controls& controls) {
    std::array<char, 1024> text{};
    state.file.copy(text.data(), text.size() - 1);
    if (ImGui::InputText("open", text.data(), text.size(), ImGuiInputTextFlags_EnterReturnsTrue))
        state.asked.open = true;
    controls.note("open");
    state.file = text.data();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("a scene, or an environment (.hdr, .exr); or drop it here");
}

void drawFacts(const PanelState& state, const PanelFacts& facts) {
    ImGui::TextUnformatted(facts.device.c_str());
    ImGui::Text("%ux%u, %.1f ms a frame, frame %llu", state.render.extent.width, state.render.extent.height,
                facts.frameMilliseconds, static_cast<unsigned long long>(facts.frames));
    if (facts.samplesInMean > 0)
        ImGui::Text("%llu samples", static_cast<unsigned long long>(facts.samplesInMean));
    if (!facts.message.empty()) ImGui::TextWrapped("%s", facts.message.c_str());
    if (facts.fault.empty()) return;
    ImGui::PushStyleColor(ImGuiCol_Text, {1.0f, 0.5f, 0.4f, 1.0f});
    ImGui::TextWrapped("%s", facts.fault.c_str());
    ImGui::PopStyleColor();
}

}  // namespace

void drawPanel(PanelState& state, const PanelFacts& facts, Controls& controls) {
    controls.begin();
    if (!state.shown) return;
    ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({380, std::max(ImGui::GetIO().DisplaySize.y - 16.0f, 120.0f)},
                             ImGuiCond_FirstUseEver);
    ImGui::Begin("Limpid");
    ImGui::PushItemWidth(-11.0f * ImGui::GetFontSize());  // what is left of their names
    drawFacts(state, facts);
    drawSampling(state, controls);
    drawDisplay(state, controls);
    drawTime(state, facts, controls);
    drawCamera(state, facts, controls);
    drawOpen(state, controls);
    drawPasses(state, facts, controls);
    for (const ParamGroup& group : paramGroups()) drawGroup(state.render, group, controls);
    ImGui::PopItemWidth();
    ImGui::Separator();
    ImGui::TextWrapped(
        "left button: orbit; right: look, with WASDQE to fly; middle: pan; wheel: zoom; Tab: this panel; "
        "Space: run or stop; Escape: leave");
    ImGui::End();
}

}  // namespace limpid::viewer
