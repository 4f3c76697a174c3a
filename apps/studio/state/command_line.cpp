#include "studio/state/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "renderer/method/parameters.h"

namespace limpid::studio {
namespace {

std::string triple(const vec3& v) {
    return fmt::format("{},{},{}", v.x, v.y, v.z);
}

std::string sourceOptions(const scene::SceneSource& source) {
    std::string text;
    if (!source.environment.empty()) text += " --env " + quoted(source.environment);
    for (const std::string& light : source.lights) text += " --light " + quoted(light);
    if (!source.lightFile.empty()) text += " --lights " + quoted(source.lightFile);
    if (!source.assetRoot.empty()) text += " --asset-root " + quoted(source.assetRoot);
    if (!source.background.empty()) text += " --background " + quoted(source.background);
    return text;
}

std::string deviceOption(const ShownFrame& frame) {
    return frame.device.empty() ? "" : " --device " + quoted(frame.device);
}

/// Returns the options for the frames' times, or sets the reason why they cannot be reproduced.
std::string timesOf(const ShownFrame& frame, const Playback& playback, uint64_t frames, CommandLine& result) {
    const bool moves = !frame.clip.empty() || frame.camera.find("--camera-path") != std::string::npos;
    if (frames > 1 && moves && !playback.playedThroughout())
        result.problem = "time was stopped or moved by hand since the last reset; reset, and let it play";
    return " --animation " + (frame.clip.empty() ? "none" : quoted(frame.clip)) +
           fmt::format(" --time {}", frames > 1 ? playback.startTime() : playback.shownTime());
}

/// Without those that have no effect on this picture, which `limpid render` refuses.
std::string parametersOf(RenderSettings settings) {
    const Pipeline& pipeline = settings.pipeline;
    if (pipeline.takesOneSampleALaunch() || settings.pathsTraced() != settings.pathtrace)
        settings.pathtrace.maxDepth = PathtraceSettings().maxDepth;
    const std::vector<std::string_view> groups = groupsOf(pipeline);
    std::string text;
    for (const std::string& assignment : assignmentsOf(settings))
        if (std::ranges::find(groups, parseAssignment(assignment).group) != groups.end())
            text += " --set " + assignment;
    return text;
}

}  // namespace

std::string quoted(const std::string& word) {
    const bool plain = !word.empty() && std::ranges::all_of(word, [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
               std::string_view("_-./:,=+%").find(c) != std::string_view::npos;
    });
    if (plain) return word;
    std::string result = "'";
    for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
}

CommandLine commandLineOf(const ShownFrame& frame, const Playback& playback, const std::string& pathFile) {
    CommandLine result;
    const RenderSettings& s = frame.settings;
    const bool accumulates = s.pipeline.accumulates();
    const uint64_t frames = accumulates ? 1 : playback.frames();
    result.text = "limpid render " + quoted(frame.source.scene);
    result.text += sourceOptions(frame.source) + deviceOption(frame);
    result.text += fmt::format(" {} --width {} --height {} --seed {} --jitter {} --spp {}",
                               s.pipeline.options(), s.extent.width, s.extent.height, s.seed,
                               toString(s.jitter), accumulates ? frame.samplesInMean : frame.samples);
    if (frame.shutter.isOpen())  // each sample sees another instant
        result.text +=
            fmt::format(" --samples-per-launch 1 --fps {} --shutter {} --shutter-position {}",
                        playback.framesPerSecond, frame.shutter.open, nameOf(frame.shutter.position));
    else if (accumulates)
        result.text += " --progressive";
    if (s.layers) result.text += " --aov all";
    if (s.pathtrace.samplerTea) result.text += " --sampler tea";
    if (frames > 1) result.text += fmt::format(" --frames {} --fps {}", frames, playback.framesPerSecond);
    result.text += timesOf(frame, playback, frames, result);
    if (frames > 1 && !playback.sameSettings())
        result.problem = "settings were changed since the last reset; reset first";
    if (!frame.camera.empty()) {
        result.text += " " + frame.camera;
    } else if (accumulates || playback.cameraStoodStill()) {
        const scene::CameraKey& key = playback.lastCamera();
        result.text += fmt::format(" --eye {} --target {} --fov {}", triple(key.eye), triple(key.target),
                                   frame.fovDegrees);
        if (key.up != vec3(0.0f, 1.0f, 0.0f)) result.text += " --up " + triple(key.up);
    } else if (playback.cameras().empty()) {
        result.problem = "there are too many frames since the last reset; reset first";
    } else {
        result.needsPath = true;
        result.text += " --camera-path " + quoted(pathFile);
    }
    if (!frame.weights.empty() && s.pipeline.usesNetwork())
        result.text += " --weights " + quoted(frame.weights);
    result.text += parametersOf(s);
    result.text += (frames > 1 ? " -o frame.%04d.exr" : " -o frame.exr");
    return result;
}

std::string stateCommandOf(const ShownFrame& frame, const std::string& command,
                           const std::string& stateFile) {
    scene::SceneSource source = frame.source;
    source.lightFile.clear();  // the state has the lights
    std::string text = "limpid " + command + " " + studio::quoted(source.scene) + sourceOptions(source) +
                       deviceOption(frame);
    if (!frame.clip.empty()) text += " --animation " + quoted(frame.clip);
    if (!frame.weights.empty()) text += " --weights " + quoted(frame.weights);
    return text + " --state " + quoted(stateFile);
}

std::string writingCommandOf(const std::string& text, const std::string& file) {
    return "printf '%s\\n' " + quoted(text) + " > " + quoted(file);
}

std::string pathText(const Playback& playback, float fovDegrees) {
    nlohmann::json keys = nlohmann::json::array();
    for (const scene::CameraKey& key : playback.cameras())
        keys.push_back({{"time", key.time},
                        {"eye", {key.eye.x, key.eye.y, key.eye.z}},
                        {"target", {key.target.x, key.target.y, key.target.z}},
                        {"up", {key.up.x, key.up.y, key.up.z}},
                        {"fov", fovDegrees}});
    return nlohmann::json{{"keys", keys}}.dump(1) + "\n";
}

}  // namespace limpid::studio
