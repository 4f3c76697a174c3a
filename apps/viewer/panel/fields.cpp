#include "viewer/panel/fields.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/error.h"
#include "base/log.h"
#include "viewer/looks/theme.h"
#include "viewer/panel/light_panel.h"

namespace limpid::viewer {
namespace {

using nlohmann::json;
using studio::Field;
using Kind = studio::Field::Kind;

constexpr size_t longestUnit = 7;  ///< letters of a unit that stands behind the number

float gutter() {
    return std::round(0.8f * ImGui::GetFontSize());
}

/// `value`: "1 level", "2 levels".
std::string unitBehind(const Field& field, double value) {
    const std::string& unit = field.unit;
    if (unit.empty() || unit.size() > longestUnit) return {};
    if (unit == "degrees") return "°";
    const bool one = value == 1.0 && unit.size() > 1 && unit.ends_with('s');
    return " " + (one ? unit.substr(0, unit.size() - 1) : unit);
}

/// The names that an index counts.
const std::vector<std::string>& listOf(const studio::Facts& facts, const Field& field) {
    return field.choices.front() == "cameras" ? facts.cameras : facts.images;
}

/// Draws a number. That of the time ends with the clip.
void drawNumber(const Drawing& with, const Field& field, json& value) {
    Range range(field.minimum, field.maximum, field.slider);
    if (field.key == "time") range = {0.0, std::max(with.facts.duration, 1e-3)};
    const std::string unit = unitBehind(field, value.get<double>());
    if (field.kind == Kind::Int) {
        int number = value.get<int>();
        if (with.controls.slider(field.label.c_str(), number, range, unit)) value = number;
        return;
    }
    float number = value.get<float>();
    const char* const format = field.unit == "stops" ? "{:.2f}" : field.key == "time" ? "{:.3f}" : "{:.4g}";
    // The decimal that is meant: 0.1, not 0.100000001490116.
    if (with.controls.slider(field.label.c_str(), number, range, format, unit))
        value = std::stod(fmt::format("{}", number));
}

void drawVector(const Drawing& with, const Field& field, json& value) {
    vec3 v(value[0].get<float>(), value[1].get<float>(), value[2].get<float>());
    // Dragging about five hundred pixels crosses the scene.
    const float speed = field.key == "up" ? 0.01f : 0.002f * with.facts.sceneRadius;
    const bool changed = with.controls.vector(field.label.c_str(), v, speed);
    if (ImGui::IsAnyItemActive()) with.panel.holdsPose = true;
    if (changed) value = json::array({v.x, v.y, v.z});
}

void drawControl(const Drawing& with, const Field& field, json& value) {
    const char* const name = field.label.c_str();
    switch (field.kind) {
        case Kind::Bool: {
            bool on = value.get<bool>();
            if (with.controls.toggle(name, on)) value = on;
            return;
        }
        case Kind::Int:
        case Kind::Float:
            return drawNumber(with, field, value);
        case Kind::Choice: {
            const auto found = std::ranges::find(field.choices, value.get<std::string>());
            auto chosen = static_cast<int>(found - field.choices.begin());
            if (with.controls.choice(name, field.choices, chosen, field.choiceHelp))
                value = field.choices[static_cast<size_t>(chosen)];
            return;
        }
        case Kind::Index: {
            const std::vector<std::string>& names = listOf(with.facts, field);
            if (names.empty()) return;
            int chosen = std::clamp(value.get<int>(), 0, static_cast<int>(names.size()) - 1);
            if (with.controls.choice(name, names, chosen)) value = chosen;
            return;
        }
        case Kind::Vector:
            return drawVector(with, field, value);
        default:  // drawn by hand elsewhere
            return;
    }
}

/// The dot of a changed value. Returns true if it was clicked.
bool drawDot(const Drawing& with, const Field& field) {
    const float start = ImGui::GetCursorPosX(), height = ImGui::GetFrameHeight(), width = gutter();
    ImGui::SetCursorPosX(start - width);
    const bool clicked = ImGui::InvisibleButton("##dot", {width, height});
    with.controls.note("default of " + field.label);
    const ImVec2 low = ImGui::GetItemRectMin();
    const bool hovered = ImGui::IsItemHovered();
    ImGui::GetWindowDrawList()->AddCircleFilled({low.x + 0.4f * width, low.y + 0.5f * height},
                                                (hovered ? 0.32f : 0.22f) * width,
                                                accentsOf(with.panel.memory.dark).changed);
    if (hovered) explain("changed; click for the default: " + field.defaultValue.dump());
    ImGui::SameLine(0.0f, 0.0f);
    ImGui::SetCursorPosX(start);
    return clicked;
}

std::string helpOf(const Field& field, const json& value) {
    std::string text = field.help;
    if (!field.unit.empty()) text += " [" + field.unit + "]";
    for (size_t i = 0; i < field.choiceHelp.size(); ++i)
        if (value == field.choices[i]) text += "\n\n" + field.choices[i] + ": " + field.choiceHelp[i];
    const bool number = field.kind == Kind::Int || field.kind == Kind::Float;
    if (number)
        text += fmt::format("\n{:.7g} to {:.7g}; Ctrl and a click: type it", field.minimum, field.maximum);
    return text;
}

}  // namespace

void explainRow(const Drawing& with, const std::string& text) {
    if (with.controls.rowHovered() && !ImGui::IsAnyItemActive()) explain(text);
}

void beginRows() {
    ImGui::Indent(gutter());
}

void endRows() {
    ImGui::Unindent(gutter());
}

bool isDrawn(const Drawing& with, const Field& field) {
    if (field.kind == Kind::Index) return !listOf(with.facts, field).empty();
    if (field.kind == Kind::Text || field.kind == Kind::Extent || field.kind == Kind::Settings) return false;
    constexpr std::array<std::string_view, 4> onlyWithClip{"playing", "time", "shutter", "shutter_position"};
    return std::ranges::find(onlyWithClip, field.key) == onlyWithClip.end() || with.facts.duration > 0.0;
}

void drawField(const Drawing& with, const Field& field) {
    if (!isDrawn(with, field)) return;
    if (field.kind == Kind::Lights) return drawLightList(with);
    if (field.kind == Kind::Background) return drawBackground(with);
    const json& now = with.panel.values.at(field.key);
    json value = now;
    ImGui::PushID(field.key.c_str());
    const bool changed = !field.defaultValue.is_null() && now != field.defaultValue;
    if (changed && drawDot(with, field)) value = field.defaultValue;
    drawControl(with, field, value);
    explainRow(with, helpOf(field, now));
    ImGui::PopID();
    if (value == now) return;
    try {
        studio::apply(with.panel.state, {{field.key, value}});
    } catch (const Error& fault) {  // the field keeps its value
        log::warn("{}", fault.what());
    }
}

void drawField(const Drawing& with, const char* key) {
    drawField(with, *studio::findField(key));
}

}  // namespace limpid::viewer
