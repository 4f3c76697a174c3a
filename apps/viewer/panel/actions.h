// The things that can be done once: buttons of the panel.
#pragma once

#include <vector>

#include "viewer/panel/panel.h"

namespace limpid::viewer {

struct Action {
    const char *section, *name, *help;
    studio::Request::Kind kind;
};
const std::vector<Action>& actions();

/// The buttons of a section, side by side as far as there is room.
void drawActions(const Drawing& with, const char* section);
/// One of them. `sameLine`: beside what was drawn last, if it fits.
void drawAction(const Drawing& with, const Action& action, bool sameLine);

/// Keeps the settings itself, so that this can be undone, and asks the studio for everything else.
void ask(const Drawing& with, studio::Request::Kind kind);

/// A scene or an environment.
void askToOpen(const Drawing& with, const std::string& file);

}  // namespace limpid::viewer
