// Files and texts that the window writes: pictures, camera paths, lights, commands, and positions of
// controls.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/files/file.h"
#include "command_line.h"
#include "scene/model/light_file.h"
#include "viewer/compare/picture_files.h"
#include "viewer/panel/light_desk.h"
#include "viewer_session.h"

namespace limpid::viewer {
namespace {

constexpr const char* pathFile = "flown.json";
constexpr const char* lightFile = "lights.json";

}  // namespace

void Viewer::save(const std::filesystem::path& file) {
    savePicture(file, main_, stopsOf(main_.settings().pipeline));
    say("wrote " + file.string());
    log::info("{}", facts_.message);
}

void Viewer::copyCommand() {
    if (!main_ || playback_.frames() == 0) throw Error("there is no frame yet");
    if (rig_.isFree() && rig_.hand().camera().orthographic)
        throw Error("the command line has no orthographic camera of one's own");
    const scene::Scene& scene = stage_->scene();
    ShownFrame frame{.source = settings_.source,
                     .clip = stage_->moves() ? scene.rig.clips[static_cast<size_t>(scene.clip)].name : "",
                     .weights = settings_.weights.string(),
                     .settings = main_.settings(),
                     .samples = panel_.samples,
                     .samplesInMean = main_.samples(),
                     .camera = rig_.option(settings_.startCamera),
                     .fovDegrees = fovOfLast_};
    frame.source.lightFile = panel_.lights.isChanged() ? lightFile : "";
    const CommandLine command = commandLineOf(frame, playback_, pathFile);
    if (!command.problem.empty()) throw Error(command.problem);
    if (panel_.lights.isChanged()) saveLights();
    if (command.needsPath) writeTextAtomically(pathFile, pathText(playback_, fovOfLast_));
    window_.setClipboard(command.text);
    say(command.text);
    log::info("{}", command.text);
}

void Viewer::savePath() {
    if (!rig_.isFree()) throw Error("only what the hand has flown can be saved");
    if (playback_.cameras().empty()) throw Error("nothing was flown since the last reset, or too much");
    writeTextAtomically(pathFile, pathText(playback_, fovOfLast_));
    say(fmt::format("wrote {}: {} frames, for --camera-path", pathFile, playback_.cameras().size()));
}

void Viewer::saveLights() {
    const LightDesk& desk = panel_.lights;
    if (!desk.isChanged()) throw Error("no light was changed");
    writeTextAtomically(lightFile, scene::lightFileText(desk.lights, desk.original));
    say(fmt::format("wrote {}, for --lights", lightFile));
}

/// Writes the controls' positions to the file for tests, if any has changed.
void Viewer::writeControls() {
    if (settings_.controls.empty()) return;
    std::string values = facts_.allValues;
    std::ranges::replace(values, '\n', ';');
    const std::string text =
        fmt::format(
            "frames\t{}\nsamples\t{}\nfault\t{}\nmessage\t{}\nprobe\t{}\nvalues\t{}\ncompared\t{}\n"
            "scenes\t{}\nrendering\t{}\n",
            facts_.frames, facts_.samplesInMean, facts_.fault, facts_.message, facts_.probe, values,
            facts_.comparedWith, scenesShown_, rendering_ ? "yes" : "no") +
        controls_.text();
    if (text == controlsText_) return;
    controlsText_ = text;
    writeTextAtomically(settings_.controls, text);
}

/// Written before a frame begins, since nothing else is written while it is computed.
void Viewer::noteRendering(bool now) {
    if (std::exchange(rendering_, now) != now && now) writeControls();
}

}  // namespace limpid::viewer
