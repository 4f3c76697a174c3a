#include "viewer/panel/panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <string>

#include "base/text/bytes_text.h"
#include "renderer/frame/parameters.h"
#include "renderer/frame/presets.h"
#include "viewer/panel/light_panel.h"

namespace limpid::viewer {

using studio::Facts;
using studio::PassTrack;
using studio::Request;
using studio::State;
using studio::Track;

namespace {

/// A button that asks for something to be done once.
void ask(PanelState& panel, Controls& controls, const char* name, Request::Kind kind) {
    if (controls.button(name)) panel.asked.push_back({.kind = kind});
}

const Range stopsRange(-32.0, 32.0, {-16.0, 16.0});

/// Returns true if the user changed the value.
bool editValue(Controls& controls, const ParamInfo& info, ParamValue& value) {
    const char* const name = info.name.c_str();
    if (bool* const on = std::get_if<bool>(&value)) return controls.checkbox(name, *on);
    const Range range(info.minimum, info.maximum, info.slider);
    if (int* const number = std::get_if<int>(&value)) return controls.slider(name, *number, range);
    return controls.slider(name, std::get<float>(value), range);
}

void drawGroup(RenderSettings& settings, const ParamGroup& group, Controls& controls) {
    controls.setGroup("");
    if (!controls.header(group.name.c_str())) return;
    controls.setGroup(group.name);
    ImGui::PushID(group.name.c_str());
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

/// Choosing an integrator that supports no denoiser turns the denoiser off.
void drawIntegrators(Pipeline& chosen, Controls& controls) {
    const std::vector<Integrator>& all = integrators();
    std::vector<std::string> names;
    for (const Integrator integrator : all) names.emplace_back(nameOf(integrator));
    auto index = static_cast<int>(std::ranges::find(all, chosen.integrator) - all.begin());
    if (controls.choice("integrator", names, index)) {
        chosen.integrator = all[static_cast<size_t>(index)];
        if (!canBeDenoised(chosen.integrator)) chosen.denoiser = nullptr;
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", std::string(helpOf(chosen.integrator)).c_str());
}

/// Choosing a denoiser that the integrator does not support selects the path tracer.
void drawDenoisers(Pipeline& chosen, Controls& controls) {
    std::vector<std::string> names;
    int index = 0;
    for (const std::string_view name : denoiserNames()) {
        if (name == nameOf(chosen.denoiser)) index = static_cast<int>(names.size());
        names.emplace_back(name);
    }
    if (controls.choice("denoiser", names, index)) {
        chosen.denoiser = parseDenoiser(names[static_cast<size_t>(index)]);
        if (chosen.denoiser && !canBeDenoised(chosen.integrator)) chosen.integrator = Integrator::Path;
    }
    if (ImGui::IsItemHovered() && chosen.denoiser)
        ImGui::SetTooltip("%s", std::string(chosen.denoiser->help).c_str());
}

void drawPipelines(State& state, Controls& controls) {
    Pipeline chosen = state.render.pipeline;
    drawIntegrators(chosen, controls);
    drawDenoisers(chosen, controls);
    if (chosen != state.render.pipeline) {
        if (!state.isPreview()) state.pipelineBefore = state.render.pipeline;
        state.render.pipeline = chosen;
    }
    bool preview = state.isPreview();
    if (controls.checkbox("preview", preview)) state.setPreview(preview);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("first hits, shaded by a light at the camera: fast, for finding one's way (V)");
}

/// A click applies the whole preset, including its integrator and denoiser.
void drawPresets(State& state, Controls& controls) {
    if (!controls.header("presets")) return;
    for (const Preset& preset : presets()) {
        if (controls.button(preset.name.c_str())) {
            const bool fits = preset.isFor(state.render.pipeline);
            if (!fits) state.render.pipeline = preset.pipeline();
            applyOnlyPreset(state.render, preset.name);
            state.jitter = studio::jitterChoice(preset.jitter, state.render.pipeline);
        }
        if (ImGui::IsItemHovered()) {
            ImGui::BeginTooltip();
            ImGui::PushTextWrapPos(30.0f * ImGui::GetFontSize());
            ImGui::TextUnformatted(preset.help.c_str());
            ImGui::PopTextWrapPos();
            ImGui::EndTooltip();
        }
    }
}

/// Draws the controls for the pass that is selected in the list.
void drawInspector(State& state, const std::string& probe, const Facts& facts, Controls& controls) {
    if (state.pass.empty() || facts.images.empty()) return;
    state.image = std::min(state.image, static_cast<int>(facts.images.size()) - 1);
    controls.choice("image", facts.images, state.image);
    controls.choice("channels", {"color", "red", "green", "blue", "alpha"}, state.view.channels);
    controls.slider("brightness, stops", state.view.stops, stopsRange, "{:.2f}");
    controls.checkbox("false color", state.view.falseColor);
    ImGui::TextUnformatted(probe.c_str());
}

void plot(const char* name, const Track& track, ImVec2 size, const char* text = nullptr) {
    const float largest = track.values().empty() ? 1.0f : *std::ranges::max_element(track.values());
    ImGui::PlotLines(name, track.values().data(), static_cast<int>(track.values().size()), 0, text, 0.0f,
                     1.1f * largest, size);
}

/// A click on a pass shows its images; another click shows the picture again.
void drawPasses(State& state, const std::string& probe, const Facts& facts, Controls& controls) {
    if (!controls.header("passes")) return;
    drawInspector(state, probe, facts, controls);
    const std::string last = fmt::format("{:.1f} ms a frame", facts.timings.frames().last());
    plot("##frames", facts.timings.frames(),
         {ImGui::GetContentRegionAvail().x, 3.0f * ImGui::GetTextLineHeight()}, last.c_str());
    controls.note("frame times", last);
    const std::string memory = fmt::format("memory {}, of it the scene's {}", bytesText(facts.memoryBytes),
                                           bytesText(facts.sceneBytes));
    ImGui::TextUnformatted(memory.c_str());
    controls.note("memory", memory);
    if (!ImGui::BeginTable("passes", 3, ImGuiTableFlags_RowBg)) return;
    const float graphWidth = 6.0f * ImGui::GetFontSize();
    ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("graph", ImGuiTableColumnFlags_WidthFixed, graphWidth);
    ImGui::TableSetupColumn("time", ImGuiTableColumnFlags_WidthFixed, 5.0f * ImGui::GetFontSize());
    for (const PassTrack& pass : facts.timings.passes()) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        if (ImGui::Selectable(pass.name.c_str(), pass.name == state.pass,
                              ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowItemOverlap))
            state.pass = pass.name == state.pass ? std::string() : pass.name;
        controls.note("pass " + pass.name);
        ImGui::TableNextColumn();
        plot(("##" + pass.name).c_str(), pass.milliseconds, {graphWidth, ImGui::GetTextLineHeight()});
        ImGui::TableNextColumn();
        ImGui::Text("%.3f ms", static_cast<double>(pass.milliseconds.last()));
    }
    ImGui::EndTable();
}

void drawComparison(State& state, const Facts& facts, Controls& controls) {
    controls.choice("compare with", studio::comparisonNames(), state.comparison.with);
    if (!state.comparison.isOn()) return;
    if (state.comparison.isReference())
        controls.slider("reference samples", state.comparison.referenceSamples,
                        {1, 1 << 16, {1, 1 << 16, SliderScale::Logarithmic}});
    ImGui::TextUnformatted(facts.scores.empty() ? "..." : facts.scores.c_str());
    controls.note("scores", facts.scores);
}

void drawLooking(PanelState& panel, Controls& controls) {
    controls.checkbox("magnifier", panel.magnifier);
    ImGui::SameLine();
    controls.checkbox("arrows", panel.state.arrows);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("motion since the frame before, with a denoiser");
}

void drawSampling(State& state, Controls& controls) {
    drawPipelines(state, controls);
    int samples = static_cast<int>(state.samples), seed = static_cast<int>(state.render.seed);
    if (controls.slider("samples a frame", samples, {1, 64, {1, 64, SliderScale::Logarithmic}}))
        state.samples = static_cast<uint32_t>(samples);
    controls.slider("max samples", state.maxSamples, {1, 1 << 20, {1, 1 << 20, SliderScale::Logarithmic}});
    if (controls.slider("seed", seed, {0, 0x7fffffff, {0, 1000}}))
        state.render.seed = static_cast<uint32_t>(seed);
    controls.choice("jitter", {"as the pipeline needs it", "pixel", "frame", "off"}, state.jitter);
    auto resolution = static_cast<int>(state.resolution);
    if (controls.choice("resolution", {"automatic", "full", "1/2", "1/4", "1/8"}, resolution))
        state.resolution = static_cast<studio::Resolution>(resolution);
}

void drawDisplay(PanelState& panel, Controls& controls) {
    controls.slider("exposure, stops", panel.state.exposure, stopsRange, "{:.2f}");
    ask(panel, controls, "measure exposure", Request::Kind::MeasureExposure);
    ImGui::SameLine();
    ask(panel, controls, "screenshot", Request::Kind::SavePng);
    ImGui::SameLine();
    ask(panel, controls, "EXR", Request::Kind::SaveExr);
    ImGui::SameLine();
    controls.checkbox("layers", panel.state.render.layers);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("in the EXR file; the path tracer alone is slower with them");
    ask(panel, controls, "copy command line", Request::Kind::CommandLine);
}

void drawTime(PanelState& panel, const Facts& facts, Controls& controls) {
    State& state = panel.state;
    controls.checkbox("running", state.running);
    ImGui::SameLine();
    ask(panel, controls, "step", Request::Kind::Step);
    ImGui::SameLine();
    ask(panel, controls, "reset", Request::Kind::Reset);
    if (facts.duration <= 0.0) return;
    ImGui::SameLine();
    controls.checkbox("playing", state.playing);
    controls.slider("time, s", state.time, {0.0, facts.duration}, "{:.3f}");
}

void drawCamera(PanelState& panel, const Facts& facts, Controls& controls) {
    State& state = panel.state;
    if (!facts.cameras.empty()) controls.choice("camera", facts.cameras, state.camera);
    controls.slider("field of view", state.fovDegrees, {0.01, 179.0, {5.0, 150.0}}, "{:.1f}");
    // Dragging about a thousand pixels crosses the scene.
    const float speed = 0.002f * facts.sceneRadius;
    controls.vector("eye", state.pose.eye, speed);
    controls.vector("target", state.pose.target, speed);
    controls.vector("up", state.pose.up, 0.01f);
    panel.holdsPose = ImGui::IsAnyItemActive();
    ask(panel, controls, "reset camera", Request::Kind::ResetCamera);
    ImGui::SameLine();
    ask(panel, controls, "see everything", Request::Kind::SeeAll);
    ImGui::SameLine();
    ask(panel, controls, "save path flown", Request::Kind::SavePath);
}

void drawOpen(PanelState& panel, Controls& controls) {
    std::array<char, 1024> text{};
    panel.file.copy(text.data(), text.size() - 1);
    const bool entered =
        ImGui::InputText("open", text.data(), text.size(), ImGuiInputTextFlags_EnterReturnsTrue);
    controls.note("open");
    panel.file = text.data();
    if (entered) panel.asked.push_back({.kind = Request::Kind::Open, .file = panel.file});
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("a scene, or an environment (.hdr, .exr); or drop it here");
}

/// What takes longer than a frame.
void drawActivity(PanelState& panel, const Facts& facts, Controls& controls) {
    if (!facts.activity.empty()) {
        ImGui::TextUnformatted(facts.activity.c_str());
        ImGui::SameLine();
        ask(panel, controls, "cancel", Request::Kind::CancelLoading);
    } else {
        ImGui::TextUnformatted(facts.computing ? "computing" : "finished");
    }
}

void drawFacts(const State& state, const Facts& facts) {
    ImGui::TextUnformatted(facts.device.c_str());
    ImGui::Text("%ux%u, %.1f ms a frame, frame %llu", state.render.extent.width, state.render.extent.height,
                static_cast<double>(facts.timings.frames().last()),
                static_cast<unsigned long long>(facts.frames));
    if (facts.samplesInMean > 0)
        ImGui::Text("mean of %llu samples", static_cast<unsigned long long>(facts.samplesInMean));
    else
        ImGui::TextUnformatted("with histories of earlier frames");
}

/// Drawn in a separate corner, so that no control moves away under the mouse.
void drawMessages(const Facts& facts) {
    const std::string message = facts.messageIsOld ? std::string() : facts.message;
    if (message.empty() && facts.fault.empty() && facts.allValues.empty()) return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x - 8.0f, size.y - 8.0f}, ImGuiCond_Always, {1.0f, 1.0f});
    ImGui::SetNextWindowBgAlpha(0.7f);
    ImGui::Begin("messages", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
    ImGui::PushTextWrapPos(std::max(0.6f * size.x, 200.0f));
    if (!facts.allValues.empty()) ImGui::TextUnformatted(facts.allValues.c_str());
    if (!message.empty()) ImGui::TextUnformatted(message.c_str());
    if (!facts.fault.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, {1.0f, 0.5f, 0.4f, 1.0f});
        ImGui::TextUnformatted(facts.fault.c_str());
        ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
    ImGui::End();
}

}  // namespace

void drawPanel(PanelState& panel, const Facts& facts, Controls& controls) {
    drawMessages(facts);
    if (!panel.shown) return;
    ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(
        {29.0f * ImGui::GetFontSize(), std::max(ImGui::GetIO().DisplaySize.y - 16.0f, 120.0f)},
        ImGuiCond_FirstUseEver);
    ImGui::Begin("Limpid");
    ImGui::PushItemWidth(-11.0f * ImGui::GetFontSize());  // leaves room for the names
    State& state = panel.state;
    drawFacts(state, facts);
    drawActivity(panel, facts, controls);
    drawSampling(state, controls);
    drawDisplay(panel, controls);
    drawTime(panel, facts, controls);
    drawCamera(panel, facts, controls);
    drawOpen(panel, controls);
    drawLooking(panel, controls);
    drawComparison(state, facts, controls);
    drawLights(panel, facts, controls);
    drawPasses(state, panel.probe, facts, controls);
    drawPresets(state, controls);
    for (const ParamGroup& group : paramGroups()) drawGroup(state.render, group, controls);
    ImGui::PopItemWidth();
    ImGui::Separator();
    ImGui::TextWrapped(
        "left button: orbit; double click: look at this; right: look, with WASDQE to fly; middle: pan; "
        "wheel: zoom; V: preview; P: all values under the mouse; Tab: this panel; Space: run or stop; "
        "Escape: leave");
    ImGui::End();
}

}  // namespace limpid::viewer
