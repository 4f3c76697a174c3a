// The panel beside the picture: what is rendered, how, and how long it takes.
#pragma once

#include <string>
#include <vector>

#include "studio/session.h"
#include "viewer/camera/controls.h"

namespace limpid::viewer {

/// What the panel changes: the studio's state, and what belongs to this window alone.
struct PanelState {
    studio::State state;
    std::vector<studio::Request> asked;  ///< whoever sends them clears it
    std::string file;                    ///< scene or environment to open
    float divider = 0.65f;   ///< share of the window's width: what is compared with lies right of it
    bool magnifier = false;  ///< beside the mouse
    bool shown = true;
    bool holdsPose = false;  ///< a control is held or typed into: State::pose is what it says
    std::string probe;       ///< what lies under the mouse in the image that is inspected
};

/// ImGui's calls for it.
void drawPanel(PanelState& panel, const studio::Facts& facts, Controls& controls);

}  // namespace limpid::viewer
