#include "cli/options/sequence_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/log.h"
#include "cli/console/help_text.h"
#include "cli/render/clip_output.h"
#include "scene/motion/movement.h"

namespace limpid::cli {
namespace {

constexpr double builtinPathSeconds = 10.0;
/// Built-in paths have 60 keys per second.
constexpr double longestBuiltinPath = 1e5;
constexpr int maxFrames = 1000000;

/// True if the output can hold several frames: its name has a frame number, or it is a clip.
bool holdsFrames(const FramePattern& output) {
    return output.numbered() || isClip(output.format(0));
}

/// Returns the number of frames from the first one's time to `seconds`.
int framesUntil(double seconds, const SequenceTiming& timing) {
    const double frames =
        std::floor(std::max(seconds - timing.start, 0.0) * timing.framesPerSecond + 1e-6) + 1.0;
    if (frames <= maxFrames) return static_cast<int>(frames);
    throw UsageError(
        fmt::format("the animation and the camera path last {:g} s, which is {:g} frames at {:g} a second, "
                    "more than {}: choose "
                    "--frames",
                    seconds, frames, timing.framesPerSecond, maxFrames));
}

}  // namespace

void addSequenceOptions(CLI::App& command, SequenceChoice& choice) {
    const OptionGroup group(command, "Animation");
    command.add_option("--animation", choice.animation,
                       "Clip by name or number, 'all' together, or 'none' for the rest pose; default: the "
                       "first if there are several frames, --time or --shutter");
    command
        .add_option("--frames", choice.frames,
                    "Number of frames, with %04d in OUTPUT; default: all of the animation")
        ->check(CLI::Range(1, maxFrames));
    command.add_option("--fps", choice.timing.framesPerSecond, "Frames per second (30)")
        ->check(CLI::Range(1e-3, 1e6));
    command.add_option("--time", choice.timing.start, "Time of the first frame, seconds (0)")
        ->check(CLI::Range(-1e6, 1e6))
        ->each([&choice](const std::string&) { choice.timeGiven = true; });
    command.add_option("--camera-path", choice.cameraPath,
                       "Camera path: a JSON file (docs/animation.md), orbit, dolly or shake");
    command
        .add_option("--shutter", choice.timing.shutter.open,
                    "Motion blur: how long the shutter is open, in frames (0: none; 0.5 as film cameras); "
                    "each launch of samples sees another instant")
        ->check(CLI::Range(0.0, 100.0));
    command
        .add_option_function<std::string>(
            "--shutter-position",
            [&choice](const std::string& name) {
                choice.timing.shutter.position = parseShutterPosition(name);
            },
            "At the frame's time, the shutter opens (start), is halfway (center, default) or closes (end)")
        ->check(CLI::IsMember({"start", "center", "end"}));
}

void chooseAnimation(const SequenceChoice& choice, const FramePattern& output, scene::Scene& scene) {
    if (choice.animation == "none") return;
    const bool timeMatters =
        choice.timeGiven || choice.frames > 1 || choice.timing.shutter.isOpen() || holdsFrames(output);
    if (choice.animation.empty() && (!timeMatters || scene.rig.clips.empty())) return;
    scene::chooseClip(scene, choice.animation);
    const scene::Clip& clip = scene.rig.clips[static_cast<size_t>(scene.clip)];
    log::info("animation '{}', {:.2f} s", clip.name, clip.duration());
}

std::optional<scene::CameraPath> chosenPath(const SequenceChoice& choice, const scene::Scene& scene,
                                            const scene::Camera& camera) {
    if (choice.cameraPath.empty()) return std::nullopt;
    if (!scene::isBuiltinCameraPath(choice.cameraPath)) return scene::loadCameraPath(choice.cameraPath);
    const double seconds =
        choice.frames > 0 ? choice.timing.timeOf(static_cast<uint64_t>(choice.frames)) : builtinPathSeconds;
    if (seconds > longestBuiltinPath)
        throw UsageError(fmt::format("--camera-path {}: the frames last {:g} s; a built-in path at most {:g}",
                                     choice.cameraPath, seconds, longestBuiltinPath));
    return scene::builtinCameraPath(choice.cameraPath, scene, camera, seconds);
}

int frameCount(const SequenceChoice& choice, const FramePattern& output, const scene::Scene& scene,
               const std::optional<scene::CameraPath>& path) {
    int frames = choice.frames;
    if (frames == 0) {
        double seconds = 0.0;
        if (scene.clip != scene::none)
            seconds = double{scene.rig.clips[static_cast<size_t>(scene.clip)].duration()};
        if (path) seconds = std::max(seconds, path->duration());
        frames = holdsFrames(output) ? framesUntil(seconds, choice.timing) : 1;
    }
    if (frames > 1 && !holdsFrames(output))
        throw UsageError("'" + output.text() +
                         "': the name of several frames holds a number, as in frame.%04d.exr");
    return frames;
}

}  // namespace limpid::cli
