// `limpid view`: opens the window.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <optional>

#include "base/error.h"
#include "cli/options/device_options.h"
#include "cli/options/pipeline_options.h"
#include "cli/options/scene_options.h"
#include "commands.h"
#include "renderer/frame/parameters.h"
#include "renderer/frame/presets.h"
#include "studio/command_line.h"
#include "studio/kept_settings.h"
#ifdef LIMPID_HAVE_VIEWER
#include "viewer/viewer.h"
#endif

namespace limpid::cli {
namespace {

struct ViewOptions {
    SceneChoice scene;
    DeviceChoice device;
    PipelineChoice pipeline;
    bool preview = false;
    std::optional<uint32_t> samples;
    std::optional<uint64_t> maxSamples;
    std::optional<int> shrink;
    std::string settings = "auto", animation, weights, screenshot, controls, shaders;
    std::string preset;
    std::vector<std::string> assignments;
    uint32_t width = 1000, height = 720, seed = 0;
    uint64_t frames = 0, loseDeviceAt = 0;
};

#ifdef LIMPID_HAVE_VIEWER
std::string eyeOptions(const SceneChoice& choice) {
    return fmt::format(" --eye {} --target {}{}", fmt::join(choice.eye, ","), fmt::join(choice.target, ","),
                       choice.fov > 0.0f ? fmt::format(" --fov {}", choice.fov) : "") +
           (choice.up.empty() ? std::string() : fmt::format(" --up {}", fmt::join(choice.up, ",")));
}

/// Returns the saved settings, overridden by the command line.
viewer::ViewSettings settingsOf(const ViewOptions& o) {
    viewer::ViewSettings view{.studio = {}, .controls = o.controls, .kept = {}};
    if (o.settings != "none")
        view.kept = o.settings == "auto" ? studio::keptSettingsFile() : std::filesystem::path(o.settings);
    studio::StudioSettings& settings = view.studio;
    settings.source = o.scene.source;
    settings.animation = o.animation;
    settings.preview = o.preview;
    settings.weights = o.weights;
    settings.shaders = o.shaders;
    settings.quitAfter = o.frames;
    settings.loseDeviceAt = o.loseDeviceAt;
    settings.screenshot = o.screenshot;
    restoreSettings(view.kept, settings);
    settings.samples = o.samples.value_or(settings.samples);
    settings.maxSamples = o.maxSamples.value_or(settings.maxSamples);
    if (o.shrink) settings.resolution = static_cast<studio::Resolution>(*o.shrink + 1);
    // A given number of frames is for scripts, which want the same pictures on every device.
    if (o.frames > 0 && !o.shrink) settings.resolution = studio::Resolution::Full;
    settings.render.extent = {o.width, o.height};
    settings.render.pipeline = pipelineFor(o.preset, o.pipeline, settings.render.pipeline);
    settings.render.seed = o.seed;
    if (!o.scene.camera.empty()) settings.startCamera = "--camera " + studio::quoted(o.scene.camera);
    if (!o.scene.eye.empty()) settings.startCamera += eyeOptions(o.scene);
    if (!o.preset.empty()) {
        applyOnlyPreset(settings.render, o.preset);
        settings.jitter = settings.render.jitter;
    }
    for (const std::string& text : o.assignments) assign(settings.render, text);
    return view;
}
#endif

void run([[maybe_unused]] const ViewOptions& o) {
#ifdef LIMPID_HAVE_VIEWER
    const viewer::ViewSettings settings = settingsOf(o);
    const auto load = [](scene::SceneSource source) {
        source.lightFile.clear();  // the window applies these edits itself
        return scene::openScene(source);
    };
    viewer::view(
        o.device.device, [&](const gpu::Device& device) { return chosenTracer(o.device, device); }, load,
        [&](const scene::Scene& scene) { return chosenCamera(scene, o.scene); }, settings);
#else
    throw Error(
        "Limpid was built without libglfw3-dev and libimgui-dev, which the window needs; 'limpid render' "
        "writes pictures");
#endif
}

}  // namespace

void addViewCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "view",
        "Open a window to fly through a scene and try every integrator, denoiser and parameter; without a "
        "SCENE, a page to choose one from");
    auto o = std::make_shared<ViewOptions>();
    addSceneOptions(*command, o->scene, false);
    addPipelineOptions(*command, o->pipeline, "the last one; at first path", "the last one; at first none");
    command->add_flag("--preview", o->preview,
                      "Start with the fast preview: first hits, shaded by a light at the camera");
    command->add_option("--preset", o->preset,
                        "Use all settings of a paper, course or tutorial; 'limpid info' lists them");
    command->add_option("--set", o->assignments,
                        "Set a parameter: group.name=value; 'limpid info' lists them (repeatable)");
    command->add_option("--weights", o->weights,
                        "Weights file for kpcn instead of the one that comes with Limpid");
    command->add_option("--width", o->width, "Picture width, pixels (1000); the panel comes beside it")
        ->check(CLI::Range(1, 16384));
    command->add_option("--height", o->height, "Picture height, pixels (720)")->check(CLI::Range(1, 16384));
    command->add_option("--spp", o->samples, "Samples per pixel and frame; more is less noisy and slower (1)")
        ->check(CLI::Range(1, 64));
    command
        ->add_option("--max-spp", o->maxSamples,
                     "Samples per pixel at which a still picture is finished and computing stops (4096)")
        ->check(CLI::Range(1, 1 << 20));
    command->add_option(
        "--settings", o->settings,
        "File that keeps integrator, denoiser and parameters between sessions; default: limpid/view.json in "
        "$XDG_CONFIG_HOME or ~/.config; 'none' keeps nothing; the command line overrides it");
    command->add_option("--seed", o->seed, "Random seed; another seed gives other noise (0)");
    command->add_option("--animation", o->animation, "Clip by name or number, or 'all'; default: the first");
    command
        ->add_option(
            "--shrink", o->shrink,
            "Render with 2^N times fewer pixels along each axis, for slow devices (0; on CPUs automatic)")
        ->check(CLI::Range(0, 3));
    command->add_option("--shaders", o->shaders,
                        "Limpid's src folder: recompile shaders with glslc when they are saved");
    command->add_option("--controls", o->controls,
                        "For tests: write the position of each control in the window to this file");
    command->add_option("--lose-device", o->loseDeviceAt,
                        "For tests: simulate a lost device after this many frames");
    command->add_option("--frames", o->frames, "Quit after this many frames (0: when the window is closed)");
    command->add_option("--screenshot", o->screenshot, "Write a PNG or EXR on exit");
    addDeviceOptions(*command, o->device);
    command->callback([o] { run(*o); });
}

}  // namespace limpid::cli
