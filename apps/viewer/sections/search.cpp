#include "viewer/sections/search.h"

#include <imgui.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "base/text/lower_case.h"
#include "renderer/method/presets.h"
#include "scene/builtin/builtin.h"
#include "viewer/panel/actions.h"
#include "viewer/panel/fields.h"
#include "viewer/sections/passes.h"
#include "viewer/sections/rows.h"

namespace limpid::viewer {
namespace {

constexpr size_t shortestStem = 3;

/// A word without the ending of its plural: "firefly" and "fireflies" are "firefl", "levels" is "level".
std::string_view stemOf(std::string_view word) {
    for (const std::string_view ending : {"ies", "y", "s"}) {
        if (word.ends_with(ending) && word.size() >= shortestStem + ending.size())
            return word.substr(0, word.size() - ending.size());
    }
    return word;
}

/// Tests one thing after the other, and writes a heading where those of another section begin.
class Finder {
  public:
    explicit Finder(const Drawing& with) : with_(with) {}

    bool finds(const std::string& section, std::span<const std::string_view> texts) {
        if (!matches(with_.panel.search, texts)) return false;
        with_.controls.setGroup("search." + section);
        if (std::exchange(heading_, section) != section) ImGui::TextDisabled("%s", section.c_str());
        return true;
    }
    bool finds(const std::string& section, std::initializer_list<std::string_view> texts) {
        return finds(section, std::span(texts.begin(), texts.size()));
    }
    bool hasFound() const { return !heading_.empty(); }

  private:
    const Drawing& with_;
    std::string heading_;
};

/// Scenes that can be opened, by their names.
void drawScenes(const Drawing& with, Finder& finder) {
    for (const scene::BuiltinInfo& info : scene::builtinScenes()) {
        const std::string file = "builtin:" + info.name;
        if (!finder.finds("scene", {file, info.help})) continue;
        if (with.controls.button(file.c_str())) askToOpen(with, file);
        if (ImGui::IsItemHovered()) explain(info.help);
    }
    for (const std::string& file : with.panel.memory.recent) {
        if (file.starts_with("builtin:") || !finder.finds("scene", {file, "recent"})) continue;
        if (with.controls.button(file.c_str())) askToOpen(with, file);
    }
}

void drawFields(const Drawing& with, Finder& finder) {
    for (const studio::Field& field : studio::fields()) {
        if (!isDrawn(with, field)) continue;
        if (finder.finds(field.section, {field.label, field.key, field.help, field.section}))
            drawField(with, field);
    }
}

}  // namespace

bool matches(const std::string& search, std::span<const std::string_view> texts) {
    const std::string wanted = lowerCase(search);
    for (size_t at = 0; at < wanted.size();) {
        const size_t end = std::min(wanted.find(' ', at), wanted.size());
        const std::string_view word = stemOf(std::string_view(wanted).substr(at, end - at));
        const bool found = std::ranges::any_of(
            texts, [&](std::string_view text) { return lowerCase(text).find(word) != std::string::npos; });
        if (!found) return false;
        at = end + 1;
    }
    return true;
}

void drawFound(const Drawing& with) {
    Finder finder(with);
    beginRows();
    drawScenes(with, finder);
    drawFields(with, finder);
    for (const ExtraRow& row : extraRows())
        if (finder.finds(row.section, row.texts)) row.draw(with);
    for (const Preset& preset : presets())
        if (finder.finds("presets", {"presets", preset.name, preset.help})) drawPreset(with, preset);
    for (const Action& action : actions())
        if (finder.finds(action.section, {action.name, action.help, action.section}))
            drawAction(with, action, false);
    endRows();
    ImGui::PushID("passes");  // its fields may have been found, too
    if (finder.finds("passes", {"passes", "times", "memory"}))
        drawPasses(with);
    else
        endPassPreview(with.panel);
    ImGui::PopID();
    with.controls.setGroup("");
    if (!finder.hasFound()) ImGui::TextDisabled("nothing is called that");
}

}  // namespace limpid::viewer
