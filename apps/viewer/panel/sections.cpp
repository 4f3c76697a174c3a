#include "viewer/panel/sections.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "base/text/lower_case.h"
#include "image/tone_curve.h"
#include "renderer/method/parameters.h"
#include "renderer/method/presets.h"
#include "scene/builtin/builtin.h"
#include "viewer/panel/actions.h"
#include "viewer/panel/fields.h"
#include "viewer/panel/light_panel.h"
#include "viewer/panel/passes.h"

namespace limpid::viewer {
namespace {

using studio::State;

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
    endRows();
}

void drawCamera(const Drawing& with) {
    if (!section(with, "camera", false)) return;
    beginRows();
    drawField(with, with.panel.state.halfHeight > 0.0f ? "half_height" : "fov");
    for (const char* key : {"eye", "target", "up", "playing", "time"}) drawField(with, key);
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

/// A click applies the whole preset, including its integrator and denoiser.
void drawPresets(const Drawing& with) {
    if (!subsection(with, "presets")) return;
    State& state = with.panel.state;
    beginRows();
    for (const Preset& preset : presets()) {
        if (with.controls.button(preset.name.c_str())) {
            const bool fits = preset.isFor(state.render.pipeline);
            if (!fits) state.render.pipeline = preset.pipeline();
            applyOnlyPreset(state.render, preset.name);
            state.jitter = studio::jitterChoice(preset.jitter, state.render.pipeline);
        }
        if (ImGui::IsItemHovered()) explain(preset.help);
    }
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

void drawPreview(const Drawing& with) {
    State& state = with.panel.state;
    bool preview = state.isPreview();
    if (with.controls.toggle("preview", preview)) state.setPreview(preview);
    explainRow(with, "First hits, shaded by a light at the camera: fast, for finding one's way (V)");
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

void drawMagnifier(const Drawing& with) {
    with.controls.toggle("magnifier", with.panel.magnifier);
    explainRow(with, "The pixels under the mouse, enlarged");
}

constexpr const char* hdrHelp =
    "High dynamic range (HDR) for displays that are in that mode: with the tone curve 'none', highlights are "
    "brighter than white";

/// Output of a high dynamic range, and what its numbers mean.
void drawHdr(const Drawing& with) {
    Memory& memory = with.panel.memory;
    const std::string& fault = with.panel.hdrFault;
    const ImVec2 low = ImGui::GetCursorScreenPos();
    bool on = memory.hdr && fault.empty();
    ImGui::BeginDisabled(!fault.empty());
    if (with.controls.toggle("hdr", on)) memory.hdr = on;
    ImGui::EndDisabled();
    // What is disabled does not say that the mouse is over it.
    const ImVec2 high{low.x + ImGui::GetContentRegionAvail().x, ImGui::GetItemRectMax().y};
    if (ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(low, high) && !ImGui::IsAnyItemActive())
        explain(fault.empty() ? hdrHelp : "No HDR here: " + fault);
    with.controls.note("hdr fault", fault);
    if (!on) return;
    with.controls.slider("paper white", memory.paperWhite,
                         Range(Memory::leastPaperWhite, Memory::mostPaperWhite), "{:.0f}", " cd/m²");
    explainRow(with, "Brightness of white in the picture and in the panel; 203 as ITU-R BT.2408 has it");
    with.controls.slider("peak", memory.peak,
                         Range(Memory::leastPeak, Memory::mostPeak,
                               {Memory::leastPeak, Memory::mostPeak, SliderScale::Logarithmic, 0.0}),
                         "{:.0f}", " cd/m²");
    explainRow(with, "What the display can show at most: brighter highlights are clipped");
}

/// The colours of stops.
void drawLegend(const Drawing& with) {
    const std::span<const vec3> colors = image::falseColors();
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const auto count = static_cast<float>(colors.size());
    const float width = ImGui::GetContentRegionAvail().x / count, height = ImGui::GetFontSize();
    ImDrawList& draws = *ImGui::GetWindowDrawList();
    for (size_t i = 0; i < colors.size(); ++i) {
        const float left = low.x + width * static_cast<float>(i);
        const vec3& c = colors[i];
        draws.AddRectFilled({left, low.y}, {left + width, low.y + height},
                            ImGui::ColorConvertFloat4ToU32({c.r, c.g, c.b, 1.0f}));
        const std::string stops = std::to_string(static_cast<int>(i) - static_cast<int>(colors.size() / 2));
        const float middle = left + 0.5f * (width - ImGui::CalcTextSize(stops.c_str()).x);
        draws.AddText({middle, low.y + height}, ImGui::GetColorU32(ImGuiCol_Text), stops.c_str());
    }
    ImGui::Dummy({width * count, 2.2f * height});
    with.controls.note("legend");
    if (ImGui::IsItemHovered()) explain("Stops from middle grey (0.18), with the exposure");
}

void drawLook(const Drawing& with) {
    if (!section(with, "look", true)) return;
    beginRows();
    drawField(with, "exposure");
    drawActions(with, "look");
    drawField(with, "tone_curve");
    if (with.panel.state.toneCurve == image::ToneCurve::FalseColor) drawLegend(with);
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

constexpr const char* themeHelp = "The colours of the window: light instead of dark";

void drawTheme(const Drawing& with) {
    bool light = !with.panel.memory.dark;
    if (with.controls.toggle("light theme", light)) with.panel.memory.dark = !light;
    explainRow(with, themeHelp);
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

bool matches(const std::string& search, std::initializer_list<std::string_view> texts) {
    const std::string wanted = lowerCase(search);
    for (size_t at = 0; at < wanted.size();) {
        const size_t end = std::min(wanted.find(' ', at), wanted.size());
        const std::string word = wanted.substr(at, end - at);
        const bool found = std::ranges::any_of(
            texts, [&](std::string_view text) { return lowerCase(text).find(word) != std::string::npos; });
        if (!found) return false;
        at = end + 1;
    }
    return true;
}

void drawFound(const Drawing& with) {
    PanelState& panel = with.panel;
    endPassPreview(panel);
    std::string heading;
    bool any = false;
    const auto under = [&](const std::string& name) {
        any = true;
        with.controls.setGroup("search." + name);
        if (std::exchange(heading, name) != name) ImGui::TextDisabled("%s", name.c_str());
    };
    beginRows();
    for (const studio::Field& field : studio::fields()) {
        using Kind = studio::Field::Kind;
        if (field.kind == Kind::Text || field.kind == Kind::Extent || field.kind == Kind::Settings) continue;
        if (!matches(panel.search, {field.label, field.key, field.help, field.section})) continue;
        under(field.section);
        drawField(with, field);
    }
    if (matches(panel.search, {"magnifier", "The pixels under the mouse, enlarged"})) {
        under("look");
        drawMagnifier(with);
    }
    if (matches(panel.search, {"hdr", "paper white", "peak", hdrHelp})) {
        under("look");
        drawHdr(with);
    }
    if (matches(panel.search, {"preview", "fast"})) {
        under("method");
        drawPreview(with);
    }
    if (matches(panel.search, {"light theme", themeHelp})) {
        under("window");
        drawTheme(with);
    }
    for (const Action& action : actions()) {
        if (!matches(panel.search, {action.name, action.help, action.section})) continue;
        under(action.section);
        drawAction(with, action, false);
    }
    endRows();
    with.controls.setGroup("");
    if (!any) ImGui::TextDisabled("nothing is called that");
}

}  // namespace limpid::viewer
