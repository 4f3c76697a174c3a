#include "viewer/panel/actions.h"

#include <imgui.h>

#include <string_view>

#include "viewer/panel/fields.h"

namespace limpid::viewer {

using RequestKind = studio::Request::Kind;

const std::vector<Action>& actions() {
    static const std::vector<Action> all{
        {"camera", "reset camera", "Back to the camera that the scene was opened with",
         RequestKind::ResetCamera},
        {"camera", "see everything", "To where the automatic camera would be", RequestKind::SeeAll},
        {"light", "add a point", "A lamp at the camera's position", RequestKind::AddPoint},
        {"light", "add a sun", "A sun above the scene", RequestKind::AddSun},
        {"look", "measure exposure", "As it is measured on the first frame of a scene",
         RequestKind::MeasureExposure},
        {"compare", "keep these settings",
         "Compares what you change from now on with the settings as they are: two of one denoiser, too",
         RequestKind::KeepSettings},
        {"output", "screenshot", "Writes limpid.png to the working folder, at the full resolution",
         RequestKind::SavePng},
        {"output", "EXR", "Writes limpid.exr to the working folder, unexposed and without a loss",
         RequestKind::SaveExr},
        {"output", "copy command line", "The 'limpid render' that makes this frame again, to the clipboard",
         RequestKind::CommandLine},
        {"output", "save path flown",
         "Writes the camera's path since the reset to flown.json, for --camera-path", RequestKind::SavePath},
        {"output", "save lights", "Writes what was changed of the lights to lights.json, for --lights",
         RequestKind::SaveLights},
        {"time", "step", "One frame, also while rendering is stopped", RequestKind::Step},
        {"time", "reset", "The next frame is the first one: means and histories begin again",
         RequestKind::Reset},
    };
    return all;
}

void drawAction(const Drawing& with, const Action& action, bool sameLine) {
    if (sameLine) sameLineFor(action.name);
    if (with.controls.button(action.name)) ask(with, action.kind);
    if (ImGui::IsItemHovered()) explain(action.help);
}

void drawActions(const Drawing& with, const char* section) {
    bool first = true;
    for (const Action& action : actions()) {
        if (std::string_view(action.section) != section) continue;
        drawAction(with, action, !std::exchange(first, false));
    }
}

void ask(const Drawing& with, RequestKind kind) {
    studio::State& state = with.panel.state;
    if (kind == RequestKind::KeepSettings)
        state.comparison.keep(withParts(state.render, state.parts));
    else
        with.panel.asked.push_back({.kind = kind});
}

void askToOpen(const Drawing& with, const std::string& file) {
    with.panel.asked.push_back({.kind = RequestKind::Open, .file = file});
    with.panel.file = file;  // the text field shows what was opened last
}

}  // namespace limpid::viewer
