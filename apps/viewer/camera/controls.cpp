#include "viewer/camera/controls.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>  // tells whether a slider is being typed into

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "image/color.h"

namespace limpid::viewer {
namespace {

constexpr float maxOfAVector = 1e9f;
constexpr float widestHelp = 26.0f;  ///< in heights of a line
constexpr float nameShare = 0.4f;    ///< of a row's width, that its name may have

/// Draws ImGui's slider over positions from 0 to 1 with the value as its text: we define the scale. A typed
/// number (Ctrl and a click) is the value itself and may lie outside the slider's span.
std::optional<double> slide(const char* name, const std::string& shown, const SliderSpan& span,
                            double value) {
    constexpr double first = 0.0, last = 1.0;
    const bool typing = ImGui::TempInputIsActive(ImGui::GetID(name));
    double number = typing ? value : sliderPosition(span, value);
    if (!ImGui::SliderScalar(name, ImGuiDataType_Double, &number, &first, &last, shown.c_str()))
        return std::nullopt;
    if (typing) return std::isnan(number) ? value : number;
    return sliderValue(span, number);
}

}  // namespace

void sameLineFor(const char* text) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float width = ImGui::CalcTextSize(text).x + 2.0f * style.FramePadding.x;
    const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    if (ImGui::GetItemRectMax().x + style.ItemSpacing.x + width <= end) ImGui::SameLine();
}

void explain(const std::string& text) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(widestHelp * ImGui::GetFontSize());
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void explainBeside(const std::string& text) {
    const float gap = 0.5f * ImGui::GetFontSize(), left = ImGui::GetWindowPos().x - gap;
    if (left > widestHelp * ImGui::GetFontSize() + 2.0f * ImGui::GetStyle().WindowPadding.x)
        ImGui::SetNextWindowPos({left, ImGui::GetIO().MousePos.y}, ImGuiCond_Always, {1.0f, 0.5f});
    explain(text);
}

void Controls::note(const std::string& name, const std::string& value) {
    const ImVec2 lower = ImGui::GetItemRectMin(), upper = ImGui::GetItemRectMax();
    note(name, value, lower.x, lower.y, upper.x, upper.y);
}

void Controls::note(const std::string& name, const std::string& value, float left, float top, float right,
                    float bottom) {
    drawn_.push_back({group_.empty() ? name : group_ + "." + name, value, left, top, right, bottom});
}

bool Controls::button(const char* name) {
    const bool pressed = ImGui::Button(name);
    note(name);
    return pressed;
}

bool Controls::checkbox(const char* name, bool& value) {
    const bool changed = ImGui::Checkbox(name, &value);
    nameHovered_ = false;
    note(name, value ? "on" : "off");
    return changed;
}

std::string Controls::beginRow(const char* name) {
    const float start = ImGui::GetCursorPosX(), whole = ImGui::GetContentRegionAvail().x;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = std::floor(nameShare * whole);
    ImGui::AlignTextToFramePadding();
    ImGui::PushClipRect(at, {at.x + width - 4.0f, at.y + 1e4f}, true);
    ImGui::TextUnformatted(name);
    ImGui::PopClipRect();
    nameHovered_ = ImGui::IsItemHovered() && ImGui::GetIO().MousePos.x < at.x + width;
    ImGui::SameLine();
    ImGui::SetCursorPosX(start + width);
    ImGui::SetNextItemWidth(-1.0f);
    return std::string("##") + name;
}

bool Controls::rowHovered() const {
    return nameHovered_ || ImGui::IsItemHovered();
}

bool Controls::toggle(const char* name, bool& value) {
    const bool changed = ImGui::Checkbox(beginRow(name).c_str(), &value);
    note(name, value ? "on" : "off");
    return changed;
}

bool Controls::text(const char* name, const char* hint, std::string& value, bool onEnter) {
    std::array<char, 1024> letters{};
    value.copy(letters.data(), letters.size() - 1);
    const bool changed =
        ImGui::InputTextWithHint((std::string("##") + name).c_str(), hint, letters.data(), letters.size(),
                                 onEnter ? ImGuiInputTextFlags_EnterReturnsTrue : ImGuiInputTextFlags_None);
    nameHovered_ = false;
    value = letters.data();
    note(name, value);
    return changed;
}

bool Controls::slider(const char* name, int& value, const Range& range, const std::string& unit) {
    const int before = value;
    if (const auto moved =
            slide(beginRow(name).c_str(), fmt::format("{}{}", value, unit), range.slider, value))
        value = static_cast<int>(std::llround(std::clamp(*moved, range.minimum, range.maximum)));
    note(name, fmt::format("{}", value));
    return value != before;
}

bool Controls::slider(const char* name, float& value, const Range& range, const char* format,
                      const std::string& unit) {
    const float before = value;
    const std::string shown = fmt::format(fmt::runtime(format), value) + unit;
    if (const auto moved = slide(beginRow(name).c_str(), shown, range.slider, static_cast<double>(value)))
        value = static_cast<float>(std::clamp(*moved, range.minimum, range.maximum));
    note(name, fmt::format("{}", value));
    return value != before;
}

bool Controls::vector(const char* name, vec3& value, float speed) {
    bool changed = false;
    beginRow(name);
    ImGui::PushID(name);
    const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float width = (ImGui::GetContentRegionAvail().x - 2.0f * gap) / 3.0f;
    const char* const axes[] = {"x", "y", "z"};
    bool hovered = nameHovered_;
    for (int i = 0; i < 3; ++i) {
        float number = value[i];
        if (i > 0) ImGui::SameLine(0.0f, gap);
        ImGui::SetNextItemWidth(width);
        ImGui::PushID(i);
        if (ImGui::DragFloat("##", &number, speed, -maxOfAVector, maxOfAVector, "%.4g",
                             ImGuiSliderFlags_NoRoundToFormat | ImGuiSliderFlags_AlwaysClamp) &&
            std::isfinite(number)) {
            value[i] = number;
            changed = true;
        }
        ImGui::PopID();
        hovered |= ImGui::IsItemHovered();
        note(std::string(name) + " " + axes[i], fmt::format("{}", value[i]));
    }
    ImGui::PopID();
    nameHovered_ = hovered;
    return changed;
}

bool Controls::header(const char* name, const std::string& noted, bool& open) {
    ImGui::SetNextItemOpen(open);
    open = ImGui::CollapsingHeader(name);
    note(noted, open ? "open" : "closed");
    return open;
}

bool Controls::tree(const char* name) {
    const bool open = ImGui::TreeNodeEx("##tree", ImGuiTreeNodeFlags_SpanAvailWidth, "%s", name);
    note("tree", open ? "open" : "closed");
    return open;
}

bool Controls::color(const char* name, vec3& value) {
    const float peak = std::max({value.r, value.g, value.b, 1e-20f});
    vec3 shown;
    for (int i = 0; i < 3; ++i) shown[i] = image::srgbEncode(value[i] / peak);
    const bool changed = ImGui::ColorEdit3(beginRow(name).c_str(), &shown.x, ImGuiColorEditFlags_None);
    note(name, fmt::format("{} {} {}", value.r, value.g, value.b));
    if (!changed) return false;
    vec3 picked;
    for (int i = 0; i < 3; ++i) picked[i] = image::srgbDecode(std::clamp(shown[i], 0.0f, 1.0f));
    const float largest = std::max({picked.r, picked.g, picked.b});
    if (largest <= 0.0f) return false;
    value = (peak > 1e-20f ? peak : 1.0f) / largest * picked;
    return true;
}

bool Controls::choice(const char* name, const std::vector<std::string>& choices, int& chosen,
                      const std::vector<std::string>& help) {
    const bool open = ImGui::BeginCombo(beginRow(name).c_str(), choices[static_cast<size_t>(chosen)].c_str(),
                                        ImGuiComboFlags_HeightLarge);
    note(name, choices[static_cast<size_t>(chosen)]);
    if (!open) return false;
    // ImGui finds its position in the first frame, in which it is not drawn.
    const bool appears = ImGui::IsWindowAppearing();
    bool changed = false;
    for (size_t i = 0; i < choices.size(); ++i) {
        const auto number = static_cast<int>(i);
        ImGui::PushID(number);  // two choices may have the same name
        if (ImGui::Selectable(choices[i].c_str(), number == chosen)) {
            changed = number != chosen;
            chosen = number;
        }
        if (i < help.size() && ImGui::IsItemHovered()) explainBeside(help[i]);
        ImGui::PopID();
        if (!appears) note(std::string(name) + "=" + choices[i]);
    }
    ImGui::EndCombo();
    return changed;
}

std::string Controls::lines() const {
    std::string all;
    for (const DrawnControl& c : drawn_)
        all += fmt::format("{:.0f}\t{:.0f}\t{:.0f}\t{:.0f}\t{}\t{}\n", c.left, c.top, c.right, c.bottom,
                           c.name, c.value);
    return all;
}

}  // namespace limpid::viewer
