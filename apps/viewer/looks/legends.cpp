#include "viewer/looks/legends.h"

#include <fmt/format.h>
#include <imgui.h>

#include <cmath>
#include <span>
#include <string>

#include "image/colormap.h"
#include "image/tone_curve.h"

namespace limpid::viewer {
namespace {

constexpr int bands = 64;  ///< of a colour map

/// A band of one colour; `low` is the upper left corner of all.
void drawBand(ImVec2 low, float width, float height, size_t number, const vec3& color) {
    const float left = low.x + width * static_cast<float>(number);
    ImGui::GetWindowDrawList()->AddRectFilled(
        {left, low.y}, {left + width, low.y + height},
        ImGui::ColorConvertFloat4ToU32({color.r, color.g, color.b, 1.0f}));
}

}  // namespace

void drawStopLegend(Controls& controls) {
    const std::span<const vec3> colors = image::falseColors();
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const auto count = static_cast<float>(colors.size());
    const float width = ImGui::GetContentRegionAvail().x / count, height = ImGui::GetFontSize();
    for (size_t i = 0; i < colors.size(); ++i) {
        drawBand(low, width, height, i, colors[i]);
        const std::string stops = std::to_string(static_cast<int>(i) - static_cast<int>(colors.size() / 2));
        const float left = low.x + width * static_cast<float>(i),
                    middle = left + 0.5f * (width - ImGui::CalcTextSize(stops.c_str()).x);
        ImGui::GetWindowDrawList()->AddText({middle, low.y + height}, ImGui::GetColorU32(ImGuiCol_Text),
                                            stops.c_str());
    }
    ImGui::Dummy({width * count, 2.2f * height});
    controls.note("legend");
    if (ImGui::IsItemHovered()) explain("Stops from middle grey (0.18), with the exposure");
}

void drawColormapLegend(Controls& controls, float stops) {
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const float whole = ImGui::GetContentRegionAvail().x, height = ImGui::GetFontSize();
    for (int i = 0; i < bands; ++i) {
        const auto [r, g, b] = image::magma((static_cast<float>(i) + 0.5f) / bands);
        drawBand(low, whole / bands, height, static_cast<size_t>(i), {r, g, b});
    }
    const std::string last = fmt::format("{:.3g} and more", std::exp2(-stops));
    const ImU32 ink = ImGui::GetColorU32(ImGuiCol_Text);
    ImDrawList& draws = *ImGui::GetWindowDrawList();
    draws.AddText({low.x, low.y + height}, ink, "0");
    draws.AddText({low.x + whole - ImGui::CalcTextSize(last.c_str()).x, low.y + height}, ink, last.c_str());
    ImGui::Dummy({whole, 2.2f * height});
    controls.note("colormap", last);
    if (ImGui::IsItemHovered()) explain("Luminance of the channels shown; magenta: infinite, or no number");
}

}  // namespace limpid::viewer
