// The panel beside the picture: what is rendered, how, and how long it takes.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "studio/session.h"
#include "viewer/camera/controls.h"
#include "viewer/looks/memory.h"
#include "viewer/panel/history.h"

namespace limpid::viewer {

/// A part of the window, in the units of mouse positions.
struct Area {
    float left = 0.0f, top = 0.0f, width = 0.0f, height = 0.0f;
};

/// The pass of the list that the pointer is over. Its images are shown while it stays there.
struct PassPreview {
    std::string pass;      ///< empty: the pointer is elsewhere
    double since = 0.0;    ///< ImGui::GetTime() when the pointer came to it
    bool clicked = false;  ///< this pass was clicked: State::pass is what the click says
    bool shown = false;    ///< State::pass is that of this preview
    std::string usually;   ///< State::pass of before; only if shown

    /// Pictures of the window are needed, although nothing happens.
    bool isAboutToShow() const { return !pass.empty() && !shown && !clicked; }
};

/// What the panel changes: the studio's state, and what belongs to this window alone.
struct PanelState {
    studio::State state;
    nlohmann::json values;               ///< studio::toJson(state) when the picture of the window was begun
    std::vector<studio::Request> asked;  ///< whoever sends them clears it
    Memory memory;
    History history;
    bool steps = false;  ///< the changes of this picture are those of undo() or redo()
    std::string file;    ///< scene or environment to open
    std::string search;  ///< empty: the sections are shown
    bool focusesSearch = false;
    float divider = 0.65f;   ///< share of the picture's width: what is compared with lies right of it
    bool magnifier = false;  ///< beside the mouse
    std::string hdrFault;    ///< why the window cannot show a high dynamic range; empty: it can
    bool shown = true;
    bool showsKeys = false;  ///< the list of keys, over everything
    bool holdsPose = false;  ///< a control is held or typed into: State::pose is what it says
    PassPreview passPreview;
    std::string probe;          ///< what lies under the mouse in the image that is inspected
    std::string reasons;        ///< why the history was kept or rejected there
    Area area;                  ///< where the picture is shown; the panel is right of it
    float statusHeight = 0.0f;  ///< pixels of the window, of the last picture
    /// ImGui::GetTime() when the frame that is being computed was begun; none: none is.
    std::optional<double> frameSince;
    std::array<uint64_t, 2> frameNumber{};  ///< Facts::frames and framesBegun of then
};

/// Width of the panel before anyone has dragged its edge, in pixels of the window at a scale of 1.
constexpr float usualPanelWidth = 400.0f;

/// Width of that panel beside a picture of this width, at a scale of 1: as wide as the picture where that is
/// narrower.
float panelWidthBeside(float picture);

/// Divides a window of this size between the picture and the panel, which gives way in small windows.
/// `scale`: how much larger than nominal everything is drawn.
Area pictureArea(const PanelState& panel, float width, float height, float scale);

/// What the panel's parts are drawn with.
struct Drawing {
    PanelState& panel;
    const studio::Facts& facts;
    Controls& controls;
};

/// ImGui's calls for it. `scale` as above.
void drawPanel(const Drawing& with, float scale);

/// Carries out a step of the history.
void undo(PanelState& panel);
void redo(PanelState& panel);

}  // namespace limpid::viewer
