#include "panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <map>

#include "renderer/parameters.h"

namespace limpid::viewer {
namespace {

/// A slider over a range of more than a thousand to one is logarithmic.
ImGuiSliderFlags scaleOf(const ParamInfo& info) {
    return info.maximum - info.minimum > 1000.0 ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None;
}

/// Whether the user changed it.
bool editValue(const ParamInfo& info, ParamValue& value) {
    const char* const name = info.name.c_str();
    if (bool* const on = std::get_if<bool>(&value)) return ImGui::Checkbox(name, on);
    if (int* const number = std::get_if<int>(&value)) {
        return ImGui::SliderInt(name, number, static_cast<int>(info.minimum), static_cast<int>(info.maximum),
                                "%d", scaleOf(info) | ImGuiSliderFlags_AlwaysClamp);
    }
    return ImGui::SliderFloat(name, &std::get<float>(value), static_cast<float>(info.minimum),
                              static_cast<float>(info.maximum), "%.4g",
                              scaleOf(info) | ImGuiSliderFlags_AlwaysClamp);
}

void drawGroup(RenderSettings& settings, const ParamGroup& group) {
    if (!ImGui::CollapsingHeader(group.name.c_str())) return;
    ImGui::PushID(group.name.c_str());
    for (const ParamPreset& preset : group.presets) {
        if (ImGui::SmallButton(("preset " + preset.name).c_str())) group.applyPreset(settings, preset.name);
        ImGui::SameLine();
    }
    if (ImGui::SmallButton("defaults")) {
        for (const ParamInfo& info : group.infos) group.set(settings, info.name, toString(info.defaultValue));
    }
    for (size_t i = 0; i < group.infos.size(); ++i) {
        const ParamInfo& info = group.infos[i];
        ParamValue value = group.get(settings, i);
        if (editValue(info, value)) group.set(settings, info.name, toString(value));
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%s%s", info.help.c_str(),
                              info.unit.empty() ? "" : (" [" + info.unit + "]").c_str());
    }
    ImGui::PopID();
}

void drawPipelines(RenderSettings& settings) {
    if (!ImGui::BeginCombo("pipeline", std::string(settings.pipeline.name()).c_str())) return;
    for (const Pipeline& pipeline : pipelines()) {
        const std::string name(pipeline.name());
        if (ImGui::Selectable(name.c_str(), pipeline == settings.pipeline)) settings.pipeline = pipeline;
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(pipeline.help()).c_str());
    }
    ImGui::EndCombo();
}

void drawPasses(const std::vector<gpu::PassTime>& passes) {
    if (!ImGui::CollapsingHeader("passes")) return;
    std::map<std::string, double> byName;
    std::vector<std::string> order;
    for (const gpu::PassTime& pass : passes) {
        if (byName.emplace(pass.name, 0.0).second) order.push_back(pass.name);
        byName[pass.name] += pass.milliseconds;
    }
    if (!ImGui::BeginTable("passes", 2, ImGuiTableFlags_RowBg)) return;
    for (const std::string& name : order) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(name.c_str());
        ImGui::TableNextColumn();
        ImGui::Text("%.3f ms", byName[name]);
    }
    ImGui::EndTable();
}

}  // namespace

void drawPanel(PanelState& state, const PanelFacts& facts) {
    if (!state.shown) return;
    ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({340, 520}, ImGuiCond_FirstUseEver);
    ImGui::Begin("Limpid");
    ImGui::TextUnformatted(facts.device.c_str());
    ImGui::Text("%ux%u, %.1f ms a frame", state.render.extent.width, state.render.extent.height,
                facts.frameMilliseconds);
    if (facts.samplesInMean > 0)
        ImGui::Text("%llu samples", static_cast<unsigned long long>(facts.samplesInMean));
    if (!facts.fault.empty()) ImGui::TextColored({1.0f, 0.5f, 0.4f, 1.0f}, "%s", facts.fault.c_str());
    drawPipelines(state.render);
    int samples = static_cast<int>(state.samples);
    if (ImGui::SliderInt("samples a frame", &samples, 1, 64, "%d", ImGuiSliderFlags_AlwaysClamp))
        state.samples = static_cast<uint32_t>(samples);
    ImGui::SliderFloat("exposure, stops", &state.exposure, -16.0f, 16.0f, "%.2f");
    if (ImGui::SmallButton("measure exposure")) state.measureExposure = true;
    ImGui::SliderAngle("field of view", &state.verticalFov, 5.0f, 150.0f);
    if (ImGui::SmallButton("reset camera")) state.resetCamera = true;
    ImGui::SameLine();
    if (ImGui::SmallButton("screenshot")) state.screenshot = true;
    drawPasses(facts.passes);
    for (const ParamGroup& group : paramGroups()) drawGroup(state.render, group);
    ImGui::Separator();
    ImGui::TextWrapped(
        "left button: orbit; right: look, with WASDQE to fly; middle: pan; wheel: zoom; Tab: this panel; "
        "Escape: leave");
    ImGui::End();
}

}  // namespace limpid::viewer
