// What the panel shows instead of its sections while something is searched.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "viewer/panel/panel.h"

namespace limpid::viewer {

/// Everything that the text in PanelState::search is found in: names, keys and help of fields, buttons,
/// presets, scenes, and the passes.
void drawFound(const Drawing& with);

/// Whether every word of `search`, without the ending of its plural, is a part of one of the texts. Letters
/// are compared without their case.
bool matches(const std::string& search, std::span<const std::string_view> texts);

}  // namespace limpid::viewer
