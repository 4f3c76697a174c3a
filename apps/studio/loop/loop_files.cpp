// Files and texts that are written on request: pictures, camera paths, lights, commands.
#include <fmt/format.h>

#include <utility>

#include "base/files/file.h"
#include "scene/lights/light_file.h"
#include "studio/compare/picture_files.h"
#include "studio/loop/render_loop.h"
#include "studio/state/command_line.h"
#include "studio/state/light_desk.h"
#include "studio/state/state_file.h"

namespace limpid::studio {
namespace {

constexpr const char* pathFile = "flown.json";
constexpr const char* lightFile = "lights.json";
constexpr const char* stateFile = "state.json";

}  // namespace

/// Writes the pictures that were asked for, once there is one of the full resolution and of the method that
/// was chosen.
void RenderLoop::saveWhatIsAsked() {
    if (toSave_.empty() || !main_ || resolution_.isCoarse() || networks_.isLoading() || isNew_) return;
    for (const std::string& extension : std::exchange(toSave_, {}))
        attempt([&] { save(unusedFile("limpid", extension)); });
}

void RenderLoop::save(const std::filesystem::path& file) {
    if (!main_) throw Error("there is no frame yet");
    savePicture(file, main_, stopsOf(main_.settings().pipeline), curveOf(main_.settings().pipeline));
    say("wrote " + file.string());
    log::info("{}", facts_.message);
}

void RenderLoop::makeCommand() {
    if (!main_ || isNew_ || playback_.frames() == 0) throw Error("there is no frame yet");
    const scene::Scene& scene = stage_->scene();
    ShownFrame frame{.source = settings_.source,
                     .device = askedDevice_,
                     .clip = stage_->moves() ? scene.rig.clips[static_cast<size_t>(scene.clip)].name : "",
                     .weights = settings_.weights.string(),
                     .settings = main_.settings(),
                     .samples = state_.samples,
                     .samplesInMean = main_.samples(),
                     .camera = rig_.option(settings_.startCamera),
                     .fovDegrees = fovOfLast_,
                     .shutter = blurOfLast_};
    frame.source.lightFile = state_.lights.isChanged() ? lightFile : "";
    CommandLine command = commandLineOf(frame, playback_, pathFile);
    if (rig_.isFree() && rig_.hand().camera().orthographic)
        command.problem = "the command line has no orthographic camera of one's own";
    const bool needsFiles = state_.lights.isChanged() || command.needsPath;
    if (!command.problem.empty() || (needsFiles && !settings_.writesFiles))
        return makeStateCommand(frame, command);
    if (state_.lights.isChanged()) saveLights();
    if (command.needsPath) writeTextAtomically(pathFile, pathText(playback_, fovOfLast_));
    giveCommand(command.text, command.text);
}

/// For frames that no command line makes again: the same view, to go on from. If no file may be written here,
/// the command writes it where it is run: beside the scene, on a machine that may have no screen.
void RenderLoop::makeStateCommand(const ShownFrame& frame, const CommandLine& command) {
    const std::string reason = command.problem.empty() ? "" : "(no 'limpid render': " + command.problem + ")";
    if (settings_.writesFiles) {
        writeStateFile(stateFile, state_);
        const std::string text = stateCommandOf(frame, "view", stateFile);
        return giveCommand(text, reason.empty() ? text : text + "\n" + reason);
    }
    const std::string text =
        writingCommandOf(stateText(state_), stateFile) + " && " + stateCommandOf(frame, "serve", stateFile);
    giveCommand(text, reason.empty() ? text : reason);
}

void RenderLoop::giveCommand(const std::string& text, const std::string& message) {
    facts_.command = text;
    ++facts_.commands;
    say(message);
    log::info("{}", text);
}

void RenderLoop::savePath() {
    if (!rig_.isFree()) throw Error("only what the hand has flown can be saved");
    if (flight_.cameras().empty()) throw Error("nothing was flown since the last reset, or too much");
    writeTextAtomically(pathFile, pathText(flight_, fovOfLast_));
    say(fmt::format("wrote {}: {} frames, for --camera-path", pathFile, flight_.cameras().size()));
}

void RenderLoop::saveLights() {
    const LightDesk& desk = state_.lights;
    if (!desk.isChanged()) throw Error("no light was changed");
    writeTextAtomically(lightFile, scene::lightFileText(desk.lights, desk.original));
    say(fmt::format("wrote {}, for --lights", lightFile));
}

}  // namespace limpid::studio
