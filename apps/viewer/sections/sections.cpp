#include "viewer/sections/sections.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "image/tone_curve.h"
#include "renderer/method/parameters.h"
#include "renderer/method/presets.h"
#include "scene/builtin/builtin.h"
#include "viewer/looks/legends.h"
#include "viewer/looks/theme.h"
#include "viewer/panel/actions.h"
#include "viewer/panel/fields.h"
#include "viewer/panel/light_panel.h"
#include "viewer/sections/passes.h"
#include "viewer/sections/rows.h"

namespace limpid::viewer {
namespace {

constexpr size_t mostNotes = 8;

/// A section in another one.
bool subsection(const Drawing& with, const std::string& name) {
    with.controls.setGroup("");
    bool& now = with.panel.memory.open.try_emplace(name, false).first->second;
    ImGui::PushStyleColor(ImGuiCol_Header, ImVec4{0, 0, 0, 0});
    const bool open = with.controls.header(name.c_str(), name, now);
    ImGui::PopStyleColor();
    return open;
}

/// Whether a section is open, which the user may change. `open`: at first.
bool section(const Drawing& with, const std::string& name, bool open) {
    with.controls.setGroup("");
    bool& now = with.panel.memory.open.try_emplace(name, open).first->second;
    return with.controls.header(name.c_str(), "section " + name, now);
}

/// A list whose choice is opened.
void drawOpenList(const Drawing& with, const char* name, const char* first,
                  const std::vector<std::string>& names, const std::vector<std::string>& files) {
    std::vector<std::string> choices{first};
    choices.insert(choices.end(), names.begin(), names.end());
    int chosen = 0;
    if (with.controls.choice(name, choices, chosen) && chosen > 0)
        askToOpen(with, files[static_cast<size_t>(chosen) - 1]);
}

/// What was added to the scene or left out.
void drawNotes(const Drawing& with) {
    const std::vector<std::string>& notes = with.facts.notes;
    ImGui::PushStyleColor(ImGuiCol_Text, accentsOf(with.panel.memory.dark).quiet);
    for (size_t i = 0; i < std::min(notes.size(), mostNotes); ++i) ImGui::TextWrapped("%s", notes[i].c_str());
    if (notes.size() > mostNotes) ImGui::TextWrapped("and %zu more", notes.size() - mostNotes);
    ImGui::PopStyleColor();
    if (!notes.empty()) with.controls.note("notes", notes.front());
}

void drawScene(const Drawing& with) {
    if (!section(with, "scene", true)) return;
    PanelState& panel = with.panel;
    beginRows();
    ImGui::SetNextItemWidth(-1.0f);
    if (with.controls.text("open", "open a file: its name, then Enter; or drop it on the window", panel.file,
                           true))
        askToOpen(with, panel.file);
    if (ImGui::IsItemHovered())
        explain("A scene (.gltf, .glb, .obj, builtin:NAME), or an environment around it (.hdr, .exr)");
    std::vector<std::string> names, files;
    for (const scene::BuiltinInfo& info : scene::builtinScenes()) {
        names.push_back(info.name);
        files.push_back("builtin:" + info.name);
    }
    drawOpenList(with, "built-in", "open one of these", names, files);
    if (!panel.memory.recent.empty()) {
        names.clear();
        for (const std::string& file : panel.memory.recent)
            names.push_back(std::filesystem::path(file).filename().string());
        drawOpenList(with, "recent", "open it again", names, panel.memory.recent);
    }
    drawField(with, "camera");
    drawNotes(with);
    endRows();
}

void drawCamera(const Drawing& with) {
    if (!section(with, "camera", false)) return;
    beginRows();
    drawField(with, with.panel.state.halfHeight > 0.0f ? "half_height" : "fov");
    for (const char* key : {"eye", "target", "up", "playing", "time", "shutter", "shutter_position"})
        drawField(with, key);
    drawActions(with, "camera");
    endRows();
}

void drawLights(const Drawing& with) {
    if (!section(with, "light", false)) return;
    with.controls.setGroup("light");
    beginRows();
    drawActions(with, "light");
    ImGui::SameLine();
    if (with.controls.button("as loaded")) with.panel.state.lights.reset();
    drawLightList(with);
    drawBackground(with);
    endRows();
    with.controls.setGroup("");
}

void drawPresets(const Drawing& with) {
    if (!subsection(with, "presets")) return;
    beginRows();
    for (const Preset& preset : presets()) drawPreset(with, preset);
    endRows();
}

void drawGroup(const Drawing& with, const ParamGroup& group) {
    if (!subsection(with, group.name)) return;
    with.controls.setGroup(group.name);
    ImGui::PushID(group.name.c_str());
    beginRows();
    for (const ParamInfo& info : group.infos) drawField(with, (group.name + "." + info.name).c_str());
    if (with.controls.button("defaults")) {
        for (const ParamInfo& info : group.infos)
            group.set(with.panel.state.render, info.name, toString(info.defaultValue));
    }
    endRows();
    ImGui::PopID();
    with.controls.setGroup("");
}

/// The parameters that change what is computed come first.
void drawParameters(const Drawing& with) {
    const std::vector<std::string_view> used = groupsOf(with.panel.state.render.pipeline);
    const auto takesPart = [&](const ParamGroup& group) {
        return std::ranges::find(used, group.name) != used.end();
    };
    for (const ParamGroup& group : paramGroups())
        if (takesPart(group)) drawGroup(with, group);
    if (!subsection(with, "other parameters")) return;
    ImGui::TextDisabled("of methods that take no part in this picture");
    for (const ParamGroup& group : paramGroups())
        if (!takesPart(group)) drawGroup(with, group);
}

/// Switches for the parts of the denoiser, to see what each contributes.
void drawParts(const Drawing& with) {
    for (size_t part = 0; part < denoiserParts.size(); ++part) {
        if (hasPart(with.panel.state.render.pipeline.denoiser, part))
            drawField(with, ("part." + std::string(denoiserParts[part].name)).c_str());
    }
}

void drawMethod(const Drawing& with) {
    if (!section(with, "method", true)) return;
    beginRows();
    drawField(with, "integrator");
    drawField(with, "denoiser");
    drawParts(with);
    drawPreview(with);
    for (const char* key : {"samples", "max_samples", "seed", "jitter", "resolution"}) drawField(with, key);
    drawPresets(with);
    drawParameters(with);
    endRows();
}

void drawLook(const Drawing& with) {
    if (!section(with, "look", true)) return;
    beginRows();
    drawField(with, "exposure");
    drawActions(with, "look");
    drawField(with, "tone_curve");
    if (with.panel.state.toneCurve == image::ToneCurve::FalseColor) drawStopLegend(with.controls);
    drawHdr(with);
    drawMagnifier(with);
    drawField(with, "arrows");
    endRows();
}

void drawScores(const Drawing& with) {
    const std::string& scores = with.facts.scores;
    ImGui::TextUnformatted(scores.empty() ? "..." : scores.c_str());
    with.controls.note("scores", scores);
    const std::vector<float>& errors = with.facts.errors.values();
    if (errors.size() < 2) return;
    const std::string last = fmt::format("FLIP {:.4f}", errors.back());
    ImGui::PlotLines("##errors", errors.data(), static_cast<int>(errors.size()), 0, last.c_str(), 0.0f,
                     1.1f * *std::ranges::max_element(errors),
                     {ImGui::GetContentRegionAvail().x, 3.0f * ImGui::GetTextLineHeight()});
    with.controls.note("errors", last);
    if (ImGui::IsItemHovered())
        explain("The error against what is compared, each time that it was measured: about once a second");
}

void drawCompare(const Drawing& with) {
    if (!section(with, "compare", true)) return;
    const studio::ComparisonChoice& choice = with.panel.state.comparison;
    beginRows();
    drawField(with, "compare");
    drawActions(with, "compare");
    if (choice.isReference()) drawField(with, "reference_samples");
    if (choice.isOn()) drawScores(with);
    endRows();
}

void drawOutput(const Drawing& with) {
    if (!section(with, "output", true)) return;
    beginRows();
    drawActions(with, "output");
    drawField(with, "layers");
    endRows();
}

void drawWindow(const Drawing& with) {
    if (!section(with, "window", false)) return;
    beginRows();
    drawTheme(with);
    endRows();
}

}  // namespace

void drawSections(const Drawing& with) {
    drawScene(with);
    drawCamera(with);
    drawLights(with);
    drawMethod(with);
    drawLook(with);
    drawCompare(with);
    if (section(with, "passes", false))
        drawPasses(with);
    else
        endPassPreview(with.panel);
    drawOutput(with);
    drawWindow(with);
}

}  // namespace limpid::viewer
