// The panel's sections, in the order in which one uses them.
#pragma once

#include "viewer/panel/panel.h"

namespace limpid::viewer {

void drawSections(const Drawing& with);
/// Everything that the text in PanelState::search is found in: name, key and help of fields, and buttons.
void drawFound(const Drawing& with);

/// Whether every word of `search` is a part of one of the texts. Letters are compared without their case.
bool matches(const std::string& search, std::initializer_list<std::string_view> texts);

}  // namespace limpid::viewer
