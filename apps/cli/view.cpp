// `limpid view`: opens the window.
#include <memory>
#include <optional>

#include "base/error.h"
#include "cli/options/studio_options.h"
#include "commands.h"
#include "studio/state/kept_settings.h"
#ifdef LIMPID_HAVE_VIEWER
#include "viewer/viewer.h"
#endif

namespace limpid::cli {
namespace {

struct ViewOptions {
    StudioChoice studio;
    std::string settings = "auto", screenshot, controls;
    std::string hdr;
    std::optional<float> paperWhite, peak;
    uint64_t frames = 0, loseDeviceAt = 0;
};

#ifdef LIMPID_HAVE_VIEWER
/// Returns the saved settings, overridden by the command line.
viewer::ViewSettings settingsOf(const ViewOptions& o) {
    viewer::ViewSettings view{.studio = {},
                              .controls = o.controls,
                              .kept = {},
                              .hdr = o.hdr.empty() ? std::optional<bool>() : o.hdr == "on",
                              .paperWhite = o.paperWhite,
                              .peak = o.peak};
    if (o.settings != "none")
        view.kept = o.settings == "auto" ? studio::keptSettingsFile() : std::filesystem::path(o.settings);
    restoreSettings(view.kept, view.studio);
    apply(o.studio, view.studio);
    view.studio.quitAfter = o.frames;
    view.studio.loseDeviceAt = o.loseDeviceAt;
    view.studio.screenshot = o.screenshot;
    // A given number of frames is for scripts, which want the same pictures on every device.
    if (o.frames > 0 && !o.studio.shrink) view.studio.resolution = studio::Resolution::Full;
    return view;
}
#endif

void run([[maybe_unused]] const ViewOptions& o) {
#ifdef LIMPID_HAVE_VIEWER
    viewer::view(o.studio.device.device, tracerChoice(o.studio), sceneLoader(), cameraStart(o.studio),
                 settingsOf(o));
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
    addStudioOptions(*command, o->studio);
    command->add_option(
        "--settings", o->settings,
        "File that keeps integrator, denoiser and parameters between sessions; default: limpid/view.json in "
        "$XDG_CONFIG_HOME or ~/.config; 'none' keeps nothing; the command line overrides it");
    command
        ->add_option(
            "--hdr", o->hdr,
            "on or off: output of a high dynamic range, for a display that is in that mode; with the "
            "tone curve 'none', highlights are brighter than white; default: the last one; at first off")
        ->check(CLI::IsMember({"on", "off"}));
    command->add_option("--paper-white", o->paperWhite, "Brightness of white with HDR, cd/m^2 (203)")
        ->check(CLI::Range(80.0f, 500.0f));
    command->add_option("--peak", o->peak, "Brightness at which HDR highlights are clipped, cd/m^2 (1000)")
        ->check(CLI::Range(200.0f, 10000.0f));
    command->add_option("--controls", o->controls,
                        "For tests: write the position of each control in the window to this file");
    command->add_option("--lose-device", o->loseDeviceAt,
                        "For tests: simulate a lost device after this many frames");
    command->add_option("--frames", o->frames, "Quit after this many frames (0: when the window is closed)");
    command->add_option("--screenshot", o->screenshot, "Write a PNG or EXR on exit");
    command->callback([o] { run(*o); });
}

}  // namespace limpid::cli
