#include "viewer.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "base/error.h"
#include "base/files/file.h"
#include "base/log.h"
#include "command_line.h"
#include "image/tonemap.h"
#include "live_render.h"
#include "networks.h"
#include "playback.h"
#include "renderer/frame/pipeline_store.h"
#include "renderer/frame/reset_rule.h"
#include "scene/framing/framing.h"
#include "scene/model/camera.h"
#include "scene/model/light_file.h"
#include "scene/motion/movement.h"
#include "shader_reload.h"
#include "stage.h"
#include "viewer/camera/camera_rig.h"
#include "viewer/camera/controls.h"
#include "viewer/camera/picker.h"
#include "viewer/camera/steering.h"
#include "viewer/compare/display.h"
#include "viewer/compare/live_comparison.h"
#include "viewer/compare/picture_files.h"
#include "viewer/panel/kept_settings.h"
#include "viewer/panel/light_desk.h"
#include "viewer/panel/panel.h"

namespace limpid::viewer {
namespace {

namespace fs = std::filesystem;

constexpr double idleSeconds = 1.0;      ///< between polls of the window while nothing is computed
constexpr double scoringSeconds = 0.05;  ///< same, while scores are computed
constexpr double longestStep = 0.1;      ///< maximum seconds that a held key moves the camera per picture
constexpr int restlessPictures = 4;      ///< drawn after the last event, until the panel has settled
constexpr double betweenTimes = 0.25;    ///< seconds between reads of the passes' times, which wait for the
                                         ///< device
constexpr double betweenSources = 0.5;   ///< seconds between checks of the shaders' files
constexpr double messageSeconds = 20.0;
constexpr uint64_t minFramesOfADevice = 30;  ///< a device lost sooner would be lost again
constexpr const char* pathFile = "flown.json";
constexpr const char* lightFile = "lights.json";

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

class Viewer {
  public:
    Viewer(const gpu::DeviceOptions& options, TracerChoice tracer, SceneLoader load, scene::Scene first,
           const scene::Camera& home, const ViewSettings& settings);
    void run();
    void storePipelines() const { limpid::storePipelines(device_, pipelineFile(device_)); }
    uint64_t rendered() const { return main_.frames(); }
    ViewSettings settingsNow() const;
    /// The state that another viewer needs to continue with the same scene.
    struct Standing {
        PanelState panel;
        scene::Camera home;
        FlyCamera hand;
        std::string clip;  ///< argument for chooseClip(); empty: none plays
        double time;
    };
    Standing standing() const;
    void takeOver(const Standing& standing);

  private:
    void load(const scene::SceneSource& source);
    void show(scene::Scene scene);
    void goTo(const scene::Camera& home);
    enum class Arrival { Named, Dropped };
    void open(const std::string& file, Arrival arrival);
    void applyLightRequests();
    void relight(const scene::SceneSource& source);
    void startAnew();
    void handleInput(double seconds);
    void fly(float seconds);
    void focus();
    void showPose();
    void placeCamera();
    void applyRequests();
    void applySettings();
    void loadNetworks();
    bool reloadShaders();
    void say(const std::string& message);
    bool messageAges();
    CameraParams cameraNow() const;
    bool mustRender(const CameraParams& camera);
    void render(const CameraParams& camera);
    void noteTimes(bool rendered);
    void measureExposure();
    float stopsOf(const Pipeline& pipeline) const;
    void save(const fs::path& file);
    void copyCommand();
    void savePath();
    void saveLights();
    void writeControls();
    void noteRendering(bool now);
    /// Runs a function that may fail because of the user's input. Shows the error in the window and returns
    /// false if it does.
    template <typename Function>
    bool attempt(const Function& function);

    ViewSettings settings_;
    TracerChoice tracer_;
    SceneLoader load_;
    Window window_;
    gpu::Device device_;
    std::unique_ptr<Stage> stage_;
    Display display_;
    CameraRig rig_;
    Playback playback_;
    PanelState panel_;
    PanelFacts facts_;
    Controls controls_;
    std::string controlsText_;  ///< as last written
    ShaderReload reload_;
    LiveRender main_;
    Networks networks_;
    LiveComparison comparison_;
    Picker picker_;
    int scenesShown_ = 0;     ///< number of scenes loaded so far
    float fovOfLast_ = 0.0f;  ///< degrees
    float speed_ = 1.0f;      ///< world units a second
    int ownShrink_ = 0;       ///< shrink if none is chosen
    Clock::time_point lastTimes_{}, lastSources_{}, lastFrame_{};
    bool frameBefore_ = false;
    bool rendering_ = false;  ///< true if this picture or the last one rendered
    Clock::time_point messageSince_{};
};

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

/// Loads a scene; leaves everything unchanged if that fails. The command line's camera and clip apply to its
/// own scene only.
void Viewer::load(const scene::SceneSource& source) {
    scene::Scene scene = load_(source);
    if (!scene.rig.clips.empty()) scene::chooseClip(scene, "");
    const scene::Camera home = scene.cameras.front();
    show(std::move(scene));
    goTo(home);
    const LightDesk before = panel_.lights;
    const bool same = source.scene == settings_.source.scene,
               sameSky = source.environment == settings_.source.environment;
    settings_.source = source;
    settings_.source.lightFile.clear();
    settings_.startCamera.clear();
    panel_.lights.show(stage_->originalLights(), settings_.source);
    if (same) panel_.lights.carry(before, sameSky);
}

void Viewer::show(scene::Scene scene) {
    auto stage = std::make_unique<Stage>(device_, std::move(scene), tracer_(device_));
    device_.waitIdle();
    main_.drop();
    comparison_.drop();
    stage_ = std::move(stage);
    ++scenesShown_;
    window_.setTitle("Limpid: " + stage_->scene().name);
    facts_.sceneRadius = std::max(stage_->sphere().radius, 1e-3f);
    playback_.reset(0.0);
}

/// Resets camera, speed and time for a scene that was just opened.
void Viewer::goTo(const scene::Camera& home) {
    rig_.show(*stage_, home);
    speed_ = 0.25f * stage_->sphere().radius;
    facts_.cameras = rig_.names();
    facts_.duration = stage_->duration();
    panel_.asked.measureExposure = panel_.asked.resetCamera = true;
}

/// Opens an environment map around the current scene, or a scene.
void Viewer::open(const std::string& file, Arrival arrival) {
    const std::string extension = fs::path(file).extension().string();
    scene::SceneSource source = settings_.source;
    if (extension == ".hdr" || extension == ".exr" || extension == ".pic") {
        source.environment = file;
        source.background.clear();
    } else {
        source.scene = file;
        // A dropped file does not imply permission to read the folders around its own.
        source.assetRoot = arrival == Arrival::Dropped ? fs::absolute(file).parent_path().string() : "";
    }
    load(source);
    say("opened " + file);
}

/// Adds or removes lamps and the background.
void Viewer::applyLightRequests() {
    PanelRequests& asked = panel_.asked;
    if (!asked.relight && !asked.addPoint && !asked.addSun && asked.removeLamp < 0) return;
    scene::SceneSource source = settings_.source;
    if (asked.addPoint || asked.addSun)
        source.lights.push_back(newLamp(asked.addSun, panel_.pose.eye, panel_.pose.target, panel_.exposure));
    if (asked.removeLamp >= 0) removeLamp(asked.removeLamp, source, panel_.lights);
    source.background = panel_.lights.backgroundText();
    asked.addPoint = asked.addSun = asked.relight = false;
    asked.removeLamp = -1;
    attempt([&] { relight(source); });
}

/// Loads the scene again with other lights; everything else is kept.
void Viewer::relight(const scene::SceneSource& source) {
    scene::Scene scene = load_(source);
    const double time = playback_.time();
    if (stage_->moves()) scene::chooseClip(scene, scene::clipChoice(stage_->scene()));
    show(std::move(scene));
    playback_.reset(time);
    // The scene's file may have changed since.
    rig_.keep(*stage_);
    panel_.camera = rig_.chosen();
    facts_.cameras = rig_.names();
    const std::string backgroundBefore = settings_.source.background;
    settings_.source = source;
    const LightDesk before = panel_.lights;
    panel_.lights.show(stage_->originalLights(), source);
    panel_.lights.carry(before, source.background == backgroundBefore);
}

/// Makes the next frame the first one.
void Viewer::startAnew() {
    playback_.reset(playback_.time());
    main_.drop();
    comparison_.drop();
}

template <typename Function>
bool Viewer::attempt(const Function& function) {
    try {
        facts_.fault.clear();
        function();
        return true;
    } catch (const Error& fault) {
        facts_.fault = fault.what();
        log::warn("{}", fault.what());
        return false;
    }
}

CameraParams Viewer::cameraNow() const {
    const gpu::Extent extent = panel_.render.extent;
    return scene::cameraParams(rig_.at(*stage_, playback_.time()), extent.width, extent.height);
}

void Viewer::handleInput(double seconds) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto pressed = [&](int key) { return !io.WantTextInput && ImGui::IsKeyPressed(key, false); };
    if (pressed(GLFW_KEY_ESCAPE)) window_.close();
    if (pressed(GLFW_KEY_TAB)) panel_.shown = !panel_.shown;
    if (pressed(GLFW_KEY_SPACE)) panel_.running = !panel_.running;
    if (pressed(GLFW_KEY_P)) panel_.asked.probe = true;
    if (pressed(GLFW_KEY_V)) panel_.setPreview(!panel_.isPreview());
    const bool divides = display_.dragsDivider(panel_, controls_);
    if (!io.WantCaptureMouse && !divides) fly(static_cast<float>(seconds));
}

void Viewer::fly(float seconds) {
    const Steering steering = Steering::now();
    if ((steering.moves() || display_.clickedTwice()) && !rig_.isFree()) {
        rig_.setFree(*stage_, playback_.time());
        panel_.fovDegrees = glm::degrees(rig_.hand().camera().verticalFov);
        startAnew();
    }
    panel_.camera = rig_.chosen();
    if (display_.clickedTwice()) attempt([&] { focus(); });
    steering.apply(rig_.hand(), seconds, speed_);
}

/// Turns the camera towards the point under the mouse.
void Viewer::focus() {
    const gpu::Extent extent = panel_.render.extent;
    if (extent.width == 0 || extent.height == 0) return;
    const auto [x, y] = display_.pixelUnderMouse(extent);
    if (const auto point = picker_.pointSeen(stage_->onDevice(), cameraNow(), extent, x, y))
        rig_.hand().focus(*point);
}

/// Updates the pose in the panel.
void Viewer::showPose() {
    // The camera normalises `up`. Showing that at once would disturb the user's typing.
    if (panel_.holdsPose) return;
    if (rig_.isFree()) {
        panel_.pose = {rig_.hand().eye(), rig_.hand().target(), rig_.hand().up()};
        return;
    }
    const scene::Camera camera = rig_.at(*stage_, playback_.time());
    const vec3 eye(camera.toWorld[3]);
    panel_.pose = {eye, eye - rig_.hand().distance() * vec3(camera.toWorld[2]), vec3(camera.toWorld[1])};
}

/// Places the camera at the panel's pose. An invalid pose changes nothing.
void Viewer::placeCamera() {
    const bool wasFree = rig_.isFree();
    rig_.place(*stage_, playback_.time(), panel_.pose.eye, panel_.pose.target, panel_.pose.up);
    panel_.camera = rig_.chosen();
    if (wasFree) return;
    panel_.fovDegrees = glm::degrees(rig_.hand().camera().verticalFov);
    startAnew();
}

/// Carries out the panel's requests.
void Viewer::applyRequests() {
    PanelRequests& asked = panel_.asked;
    if (std::exchange(asked.open, false)) attempt([&] { open(panel_.file, Arrival::Named); });
    for (const std::string& file : window_.takeDropped()) attempt([&] { open(file, Arrival::Dropped); });
    applyLightRequests();
    if (std::exchange(asked.resetCamera, false)) {
        panel_.camera = 0;
        panel_.fovDegrees = glm::degrees(rig_.home().verticalFov);
        asked.choosePose = true;
    }
    if (std::exchange(asked.choosePose, false)) {
        rig_.choose(*stage_, panel_.camera);
        panel_.playing |= rig_.movesOnPath();
        asked.reset = true;
    }
    if (std::exchange(asked.place, false)) placeCamera();
    if (std::exchange(asked.seeAll, false)) {
        rig_.stand(*stage_, scene::frameScene(stage_->scene()));
        panel_.camera = 0;
        panel_.fovDegrees = glm::degrees(rig_.hand().camera().verticalFov);
        asked.reset = true;
    }
    if (std::exchange(asked.seek, false)) playback_.seek(double{panel_.time});
    if (std::exchange(asked.reset, false)) startAnew();
    measureExposure();
    if (std::exchange(asked.probe, false) && main_)
        facts_.allValues = facts_.allValues.empty() ? display_.probeAll(main_) : std::string();
    if (std::exchange(asked.command, false)) attempt([&] { copyCommand(); });
    if (std::exchange(asked.saveLights, false)) attempt([&] { saveLights(); });
    if (std::exchange(asked.savePath, false)) attempt([&] { savePath(); });
    if (std::exchange(asked.screenshot, false) && main_) attempt([&] { save(unusedFile("limpid", ".png")); });
    if (std::exchange(asked.exr, false) && main_) attempt([&] { save(unusedFile("limpid", ".exr")); });
}

/// Derives settings from others, and restores the previous value of impossible ones.
void Viewer::applySettings() {
    const gpu::Extent window = window_.pixels();
    RenderSettings& render = panel_.render;
    const auto shrunk = [&](uint32_t pixels) {
        return pixels == 0 ? 0 : std::max(pixels >> panel_.shrink, 1u);
    };
    render.extent = {shrunk(window.width), shrunk(window.height)};
    if (panel_.jitter > 0)
        render.jitter = static_cast<Jitter>(panel_.jitter - 1);
    else
        render.jitter = defaultJitter(render.pipeline);
    rig_.hand().setVerticalFov(glm::radians(panel_.fovDegrees));
    stage_->setLights(panel_.lights.lights);
    playback_.playing = panel_.playing && (stage_->moves() || rig_.movesOnPath());
    facts_.duration = rig_.movesOnPath() || stage_->moves() ? rig_.duration(*stage_) : 0.0;
    if (facts_.duration > 0.0 && playback_.time() > facts_.duration) playback_.seek(0.0);
    panel_.time = static_cast<float>(playback_.time());
    loadNetworks();
    if (!panel_.comparison.isOn()) comparison_.drop();
}

/// Loads the networks that the pipelines need. If that fails, goes back to a pipeline without one.
void Viewer::loadNetworks() {
    RenderSettings& render = panel_.render;
    const auto have = [&](const Pipeline& pipeline) {
        return !networks_.lacks(pipeline, render.denoisers) ||
               attempt([&] { networks_.load(pipeline, render.denoisers); });
    };
    if (!have(render.pipeline)) render.pipeline = main_.settings().pipeline;
    networks_.set(render);
    if (panel_.comparison.isOn() && !have(settingsOfComparison(panel_, networks_).pipeline))
        panel_.comparison.with = 0;
}

/// Recompiles changed shaders. Returns true if there were any.
bool Viewer::reloadShaders() {
    if (!reload_.watches() || !main_ || !due(lastSources_, betweenSources)) return false;
    std::vector<gpu::ShaderCode> used = main_.renderer().graph().usedShaders();
    if (LiveRender* const other = comparison_.picture()) {
        const std::vector<gpu::ShaderCode> more = other->renderer().graph().usedShaders();
        used.insert(used.end(), more.begin(), more.end());
    }
    const std::optional<ShaderReload::Result> result = reload_.poll(used);
    if (!result) return false;
    attempt([&] {
        if (!result->fault.empty()) throw Error(result->fault);
        say(fmt::format("compiled {} shaders", result->compiled));
        startAnew();
    });
    return true;
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

/// Returns true if the next picture would differ from the last one and should be rendered.
bool Viewer::mustRender(const CameraParams& camera) {
    const gpu::Extent extent = panel_.render.extent;
    if (extent.width == 0 || extent.height == 0) return false;
    if (std::exchange(panel_.asked.step, false)) return true;
    bool changed = main_.differs(panel_.render, panel_.samples) || stage_->lightsChanged();
    if (!changed && !panel_.running) return false;
    changed = changed || !sameCamera(camera, main_.camera()) || (stage_->moves() && playback_.change()) ||
              playback_.playing;
    if (changed) {
        main_.noteChange();
        comparison_.noteChange();
    }
    return changed || settings_.quitAfter > 0 || main_.samples() < static_cast<uint64_t>(panel_.maxSamples);
}

void Viewer::render(const CameraParams& camera) {
    if (settings_.loseDeviceAt > 0 && rendered() == settings_.loseDeviceAt)
        throw gpu::DeviceLost("the device is taken for lost");
    const bool changed = main_ && (panel_.render != main_.settings() || panel_.fovDegrees != fovOfLast_);
    if (main_.prepare(*stage_, panel_.render, panel_.samples, stopsOf(panel_.render.pipeline)))
        playback_.reset(playback_.time());
    else if (changed)
        playback_.noteOtherSettings();
    Moment moment = playback_.moment(camera);
    if (stage_->lightsChanged()) playback_.noteOtherSettings();
    std::optional<Stage::Step> step;
    if (const auto change = playback_.change(); change && stage_->moves())
        step = Stage::Step{change->from, change->to};
    moment.scene = stage_->nextFrame(step, playback_.shownTime());
    if (comparison_.mustRender(panel_, camera, moment.scene.has_value()))
        comparison_.render(*stage_, panel_, moment, false);
    main_.render(std::move(moment));
    fovOfLast_ = panel_.fovDegrees;
    playback_.advance(camera, rig_.key());
    measureExposure();
    facts_.samplesInMean = main_.accumulates() ? main_.samples() : 0;
    facts_.frames = playback_.frames();
}

void Viewer::noteTimes(bool rendered) {
    const auto now = Clock::now();
    if (rendered && frameBefore_)
        facts_.timings.addFrame(std::chrono::duration<double, std::milli>(now - lastFrame_).count());
    lastFrame_ = now;
    frameBefore_ = rendered;
    if (!rendered || !due(lastTimes_, betweenTimes)) return;
    facts_.timings.addPasses(main_.renderer().passTimes());
    facts_.memoryBytes = device_.allocatedBytes();
    facts_.sceneBytes = stage_->onDevice().byteCount();
}

/// Measures the exposure once there is a picture that uses one.
void Viewer::measureExposure() {
    if (!panel_.asked.measureExposure || !main_ || !main_.settings().pipeline.needsExposure()) return;
    panel_.asked.measureExposure = false;
    const RenderedLayers layers = main_.renderer().download();
    panel_.exposure = image::autoExposure(beautyOf(layers), surfaceShare(layers));
}

/// Returns the exposure for this pipeline; 0 if its picture is not radiance.
float Viewer::stopsOf(const Pipeline& pipeline) const {
    return pipeline.needsExposure() ? panel_.exposure : 0.0f;
}

void Viewer::save(const fs::path& file) {
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

/// Opens the viewer again in the same state, on another device or on the same one if it is available again.
std::unique_ptr<Viewer> afterLoss(const gpu::DeviceOptions& device, const TracerChoice& tracer,
                                  const SceneLoader& load, std::unique_ptr<Viewer> lost) {
    ViewSettings now = lost->settingsNow();
    now.loseDeviceAt = 0;
    const Viewer::Standing standing = lost->standing();
    now.render.denoisers = standing.panel.render.denoisers;
    lost.reset();
    scene::Scene scene = load(now.source);
    if (!standing.clip.empty()) scene::chooseClip(scene, standing.clip);
    auto viewer = std::make_unique<Viewer>(device, tracer, load, std::move(scene), standing.home, now);
    viewer->takeOver(standing);
    return viewer;
}

}  // namespace

void view(const gpu::DeviceOptions& device, const TracerChoice& tracer, const SceneLoader& load,
          const std::function<scene::Camera(const scene::Scene&)>& start, const ViewSettings& settings) {
    // Before there is a window, since errors in these do not need one.
    scene::Scene first = load(settings.source);
    if (!first.rig.clips.empty()) scene::chooseClip(first, settings.animation);
    const scene::Camera home = start(first);
    if (!settings.source.lightFile.empty())
        scene::readLightFile(settings.source.lightFile, scene::lightControlsOf(first));
    const Desktop desktop;
    auto viewer = std::make_unique<Viewer>(device, tracer, load, std::move(first), home, settings);
    for (;;) {
        try {
            viewer->run();
            return viewer->storePipelines();
        } catch (const gpu::DeviceLost& fault) {
            if (viewer->rendered() < minFramesOfADevice) throw;
            log::error("{}; setting everything up anew", fault.what());
        }
        viewer = afterLoss(device, tracer, load, std::move(viewer));
    }
}

}  // namespace limpid::viewer
