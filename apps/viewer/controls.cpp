#include "controls.h"

#include <fmt/format.h>
#include <imgui.h>

namespace limpid::viewer {
namespace {

ImGuiSliderFlags scaleOf(double least, double most) {
    return (most - least > 1000.0 ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None) |
           ImGuiSliderFlags_AlwaysClamp;
}

}  // namespace

void Controls::note(const std::string& name, const std::string& value) {
    const ImVec2 lower = ImGui::GetItemRectMin(), upper = ImGui::GetItemRectMax();
    note(name, value, lower.x, lower.y, upper.x, upper.y);
}

void Controls::note(const std::string& name, const std::string& value, float left, float top, float right,
                    float bottom) {
    drawn_.push_back({group_.empty() ? name : group_ + "." + name, value, left, top, right, bottom});
}

bool Controls::button(const char* name) {
    const bool pressed = ImGui::SmallButton(name);
    note(name);
    return pressed;
}

bool Controls::checkbox(const char* name, bool& value) {
    const bool changed = ImGui::Checkbox(name, &value);
    note(name, value ? "on" : "off");
    return changed;
}

bool Controls::slider(const char* name, int& value, int least, int most) {
    const bool changed = ImGui::SliderInt(name, &value, least, most, "%d", scaleOf(least, most));
    note(name, fmt::format("{}", value));
    return changed;
}

bool Controls::slider(const char* name, float& value, float least, float most, const char* format) {
    const bool changed = ImGui::SliderFloat(name, &value, least, most, format,
                                            scaleOf(static_cast<double>(least), static_cast<double>(most)));
    note(name, fmt::format("{}", value));
    return changed;
}

bool Controls::header(const char* name) {
    const bool open = ImGui::CollapsingHeader(name);
    note(name, open ? "open" : "closed");
    return open;
}

bool Controls::choice(const char* name, const std::vector<std::string>& choices, int& chosen) {
    const bool open =
        ImGui::BeginCombo(name, choices[static_cast<size_t>(chosen)].c_str(), ImGuiComboFlags_HeightLarge);
    note(name, choices[static_cast<size_t>(chosen)]);
    if (!open) return false;
    // Its place is found out in the first frame, in which it is not shown.
    const bool appears = ImGui::IsWindowAppearing();
    bool changed = false;
    for (size_t i = 0; i < choices.size(); ++i) {
        const auto number = static_cast<int>(i);
        if (ImGui::Selectable(choices[i].c_str(), number == chosen)) {
            changed = number != chosen;
            chosen = number;
        }
        if (!appears) note(std::string(name) + "=" + choices[i]);
    }
    ImGui::EndCombo();
    return changed;
}

std::string Controls::text() const {
    std::string lines;
    for (const DrawnControl& c : drawn_)
        lines += fmt::format("{:.0f}\t{:.0f}\t{:.0f}\t{:.0f}\t{}\t{}\n", c.left, c.top, c.right, c.bottom,
                             c.name, c.value);
    return lines;
}

}  // namespace limpid::viewer
