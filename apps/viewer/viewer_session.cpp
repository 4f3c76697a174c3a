#include "viewer_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "scene/model/light_file.h"
#include "scene/motion/movement.h"
#include "viewer/panel/kept_settings.h"

namespace limpid::viewer {
namespace {

constexpr double idleSeconds = 1.0;      ///< between polls of the window while nothing is computed
constexpr double scoringSeconds = 0.05;  ///< same, while scores are computed
constexpr double longestStep = 0.1;      ///< maximum seconds that a held key moves the camera per picture
constexpr int restlessPictures = 4;      ///< drawn after the last event, until the panel has settled
constexpr double messageSeconds = 20.0;

gpu::DeviceOptions presenting(gpu::DeviceOptions options) {
    options.surfaceExtensions = Window::surfaceExtensions();
    return options;
}

/// Returns the shrink at which a CPU renders fast enough for the window to respond.
int shrinkFor(const gpu::Device& device, gpu::Extent window) {
    constexpr uint64_t maxPixels = 300'000;
    int shrink = 0;
    while (device.isCpu() && shrink < 3 && (uint64_t{window.width} * window.height >> 2 * shrink) > maxPixels)
        ++shrink;
    return shrink;
}

}  // namespace

Viewer::Viewer(const gpu::DeviceOptions& options, TracerChoice tracer, SceneLoader load, scene::Scene first,
               const scene::Camera& home, const ViewSettings& settings)
    : settings_(settings),
      tracer_(std::move(tracer)),
      load_(std::move(load)),
      window_("Limpid", settings.render.extent),
      device_(presenting(options)),
      display_(window_, device_),
      reload_(settings.shaders),
      main_(device_, reload_.replacements()),
      networks_(device_, settings.weights),
      comparison_(device_, reload_.replacements(), networks_),
      picker_(device_, reload_.replacements()) {
    loadPipelines(device_, pipelineFile(device_));
    panel_.render = settings.render;
    if (settings.preview) panel_.setPreview(true);
    if (settings.jitter) panel_.jitter = jitterChoice(*settings.jitter, settings.render.pipeline);
    panel_.samples = settings.samples;
    panel_.maxSamples = static_cast<int>(std::min<uint64_t>(settings.maxSamples, 1 << 20));
    ownShrink_ = shrinkFor(device_, window_.pixels());
    panel_.shrink = settings.shrink >= 0 ? settings.shrink : ownShrink_;
    facts_.device = device_.info().name;
    show(std::move(first));
    panel_.lights.show(stage_->originalLights(), settings_.source);
    if (!settings_.source.lightFile.empty())
        panel_.lights.lights = scene::readLightFile(settings_.source.lightFile, panel_.lights.original);
    goTo(home);
}

void Viewer::say(const std::string& message) {
    facts_.message = message;
    facts_.messageIsOld = false;
    messageSince_ = Clock::now();
}

/// Returns true if the message has just expired.
bool Viewer::messageAges() {
    if (facts_.messageIsOld || facts_.message.empty() || secondsSince(messageSince_) < messageSeconds)
        return false;
    return facts_.messageIsOld = true;
}

ViewSettings Viewer::settingsNow() const {
    ViewSettings settings = settings_;
    settings.render = panel_.render;
    settings.preview = panel_.isPreview();
    if (settings.preview) settings.render.pipeline = panel_.pipelineBefore;
    if (const gpu::Extent size = window_.size(); size.width > 0 && size.height > 0)
        settings.render.extent = size;
    settings.samples = panel_.samples;
    settings.maxSamples = static_cast<uint64_t>(panel_.maxSamples);
    // If the user has not chosen a shrink, the next device chooses its own.
    settings.shrink = settings_.shrink < 0 && panel_.shrink == ownShrink_ ? -1 : panel_.shrink;
    return settings;
}

Viewer::Standing Viewer::standing() const {
    Standing now{panel_, rig_.home(), rig_.hand(), scene::clipChoice(stage_->scene()), playback_.time()};
    now.panel.asked = {};
    now.panel.render.networks = {};  // the networks are on the device
    return now;
}

void Viewer::takeOver(const Standing& standing) {
    panel_ = standing.panel;
    rig_.choose(*stage_, panel_.camera);
    if (rig_.isFree()) rig_.hand() = standing.hand;
    playback_.reset(standing.time);
    facts_.fault = "the device was lost; everything was set up anew";
}

void Viewer::run() {
    auto last = Clock::now();
    int restless = restlessPictures;
    while (!window_.closed() && (settings_.quitAfter == 0 || rendered() < settings_.quitAfter)) {
        const double patience = comparison_.isScoring() ? scoringSeconds : idleSeconds;
        if (window_.poll(restless > 0 ? 0.0 : patience)) restless = restlessPictures;
        if (!window_.input().empty()) restless = restlessPictures;
        if (reloadShaders() || messageAges() || comparison_.hasScored()) restless = restlessPictures;
        if (restless == 0) continue;
        display_.begin();
        const auto now = Clock::now();
        controls_.begin();
        handleInput(std::min(std::chrono::duration<double>(now - last).count(), longestStep));
        last = now;
        showPose();
        drawPanel(panel_, facts_, controls_);
        applyRequests();
        applySettings();
        --restless;
        const CameraParams camera = cameraNow();
        const bool main = mustRender(camera);
        bool other = false;
        noteRendering(main);
        if (main) {
            render(camera);
        } else if (main_ && panel_.running && comparison_.mustRender(panel_, camera, false)) {
            comparison_.render(*stage_, panel_, playback_.moment(camera), true);
            other = true;
        }
        if (main_) main_.expose(stopsOf(main_.settings().pipeline));
        if (main || other) restless = restlessPictures;
        noteTimes(main);
        comparison_.update(main_, panel_.exposure, main || other);
        facts_.comparedWith = comparison_.name();
        facts_.scores = comparison_.scores();
        writeControls();
        display_.present(panel_, facts_, main_, comparison_.picture());
    }
    if (main_ && !settings_.screenshot.empty()) save(settings_.screenshot);
    attempt([&] { keepSettings(settings_.kept, settingsNow()); });
    device_.waitIdle();
    if (device_.validationMessages() > 0)
        throw Error(fmt::format("the validation layer reported {} messages", device_.validationMessages()));
}

}  // namespace limpid::viewer
