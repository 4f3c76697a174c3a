#include "viewer/sections/rows.h"

#include <imgui.h>

#include "viewer/panel/fields.h"

namespace limpid::viewer {
namespace {

constexpr const char* previewHelp =
    "First hits, shaded by a light at the camera: fast, for finding one's way (V)";
constexpr const char* magnifierHelp = "The pixels under the mouse, enlarged";
constexpr const char* hdrHelp =
    "High dynamic range (HDR) for displays that are in that mode: with the tone curve 'none', highlights are "
    "brighter than white";
constexpr const char* themeHelp = "The colours of the window: light instead of dark";

}  // namespace

void drawPreview(const Drawing& with) {
    studio::State& state = with.panel.state;
    bool preview = state.isPreview();
    if (with.controls.toggle("preview", preview)) state.setPreview(preview);
    explainRow(with, previewHelp);
}

void drawMagnifier(const Drawing& with) {
    with.controls.toggle("magnifier", with.panel.magnifier);
    explainRow(with, magnifierHelp);
}

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

void drawTheme(const Drawing& with) {
    bool light = !with.panel.memory.dark;
    if (with.controls.toggle("light theme", light)) with.panel.memory.dark = !light;
    explainRow(with, themeHelp);
}

void drawPreset(const Drawing& with, const Preset& preset) {
    studio::State& state = with.panel.state;
    if (with.controls.button(preset.name.c_str())) {
        if (!preset.isFor(state.render.pipeline)) state.render.pipeline = preset.pipeline();
        applyOnlyPreset(state.render, preset.name);
        state.jitter = studio::jitterChoice(preset.jitter, state.render.pipeline);
    }
    if (ImGui::IsItemHovered()) explain(preset.help);
}

std::span<const ExtraRow> extraRows() {
    static const std::vector<ExtraRow> rows{
        {"method", {"preview", previewHelp}, drawPreview},
        {"look", {"magnifier", magnifierHelp}, drawMagnifier},
        {"look", {"hdr", "paper white", "peak", hdrHelp}, drawHdr},
        {"window", {"window", "light theme", themeHelp}, drawTheme},
    };
    return rows;
}

}  // namespace limpid::viewer
