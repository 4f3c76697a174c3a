// Controls for the fields of the studio's state, drawn from their table (studio/state/state_json.h).
#pragma once

#include "studio/state/state_json.h"
#include "viewer/panel/panel.h"

namespace limpid::viewer {

/// One row: the name, the control, and, if the value is not the default, a dot that sets it back. Help and
/// unit appear under the mouse.
void drawField(const Drawing& with, const studio::Field& field);
void drawField(const Drawing& with, const char* key);

/// False for what is drawn elsewhere by hand, and for what there is nothing to choose from now.
bool isDrawn(const Drawing& with, const studio::Field& field);

/// Text under the mouse, if it is over the last row.
void explainRow(const Drawing& with, const std::string& text);

/// Space on the left of rows, for the dots.
void beginRows();
void endRows();

}  // namespace limpid::viewer
