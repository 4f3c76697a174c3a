#include "cli/options/studio_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "renderer/method/parameters.h"
#include "renderer/method/presets.h"
#include "studio/state/command_line.h"
#include "studio/state/state_file.h"

namespace limpid::cli {
namespace {

std::string eyeOptions(const SceneChoice& choice) {
    return fmt::format(" --eye {} --target {}{}", fmt::join(choice.eye, ","), fmt::join(choice.target, ","),
                       choice.fov > 0.0f ? fmt::format(" --fov {}", choice.fov) : "") +
           (choice.up.empty() ? std::string() : fmt::format(" --up {}", fmt::join(choice.up, ",")));
}

}  // namespace

void addStudioOptions(CLI::App& command, StudioChoice& choice) {
    addSceneOptions(command, choice.scene, false);
    addPipelineOptions(command, choice.pipeline, "the last one; at first path",
                       "the last one; at first none");
    command.add_flag("--preview", choice.preview,
                     "Start with the fast preview: first hits, shaded by a light at the camera");
    command.add_option("--preset", choice.preset,
                       "Use all settings of a paper, course or tutorial; 'limpid info' lists them");
    command.add_option("--set", choice.assignments,
                       "Set a parameter: group.name=value; 'limpid info' lists them (repeatable)");
    command.add_option(
        "--state", choice.state,
        "State of a window, as 'copy command line' writes it: camera, lights, method and look; over the "
        "other options");
    command.add_option("--weights", choice.weights,
                       "Weights file for kpcn instead of the one that comes with Limpid");
    command.add_option("--width", choice.width, "Picture width at first, pixels (1000)")
        ->check(CLI::Range(1, 16384));
    command.add_option("--height", choice.height, "Picture height at first, pixels (720)")
        ->check(CLI::Range(1, 16384));
    command
        .add_option("--spp", choice.samples, "Samples per pixel and frame; more is less noisy and slower (1)")
        ->check(CLI::Range(1, 64));
    command
        .add_option("--max-spp", choice.maxSamples,
                    "Samples per pixel at which a still picture is finished and computing stops (4096)")
        ->check(CLI::Range(1, 1 << 20));
    command.add_option("--seed", choice.seed, "Random seed; another seed gives other noise (0)");
    command.add_option("--animation", choice.animation,
                       "Clip by name or number, or 'all'; default: the first");
    command
        .add_option(
            "--shrink", choice.shrink,
            "Always render with 2^N times fewer pixels along each axis; default: only while something moves "
            "and the device is slow")
        ->check(CLI::Range(0, 3));
    command.add_option("--shaders", choice.shaders,
                       "Limpid's src folder: recompile shaders with glslc when they are saved");
    addDeviceOptions(command, choice.device);
}

void apply(const StudioChoice& choice, studio::StudioSettings& settings) {
    settings.source = choice.scene.source;
    settings.animation = choice.animation;
    settings.preview = choice.preview;
    settings.weights = choice.weights;
    settings.shaders = choice.shaders;
    settings.samples = choice.samples.value_or(settings.samples);
    settings.maxSamples = choice.maxSamples.value_or(settings.maxSamples);
    if (choice.shrink) settings.resolution = static_cast<studio::Resolution>(*choice.shrink + 1);
    settings.render.extent = {choice.width, choice.height};
    settings.render.pipeline = pipelineFor(choice.preset, choice.pipeline, settings.render.pipeline);
    settings.render.seed = choice.seed;
    if (!choice.scene.camera.empty())
        settings.startCamera = "--camera " + studio::quoted(choice.scene.camera);
    if (!choice.scene.eye.empty()) settings.startCamera += eyeOptions(choice.scene);
    if (!choice.preset.empty()) {
        applyOnlyPreset(settings.render, choice.preset);
        settings.jitter = settings.render.jitter;
    }
    for (const std::string& text : choice.assignments) assign(settings.render, text);
    if (!choice.state.empty()) settings.state = studio::readStateFile(choice.state);
}

studio::TracerChoice tracerChoice(const StudioChoice& choice) {
    return [device = choice.device](const gpu::Device& opened) { return chosenTracer(device, opened); };
}

studio::SceneLoader sceneLoader() {
    return [](scene::SceneSource source, const limpid::Progress& progress) {
        source.lightFile.clear();  // the studio applies these edits itself
        return scene::openScene(source, progress);
    };
}

studio::CameraStart cameraStart(const StudioChoice& choice) {
    return [scene = choice.scene](const scene::Scene& opened) { return chosenCamera(opened, scene); };
}

}  // namespace limpid::cli
