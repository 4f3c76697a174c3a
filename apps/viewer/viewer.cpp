#include "viewer.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <tuple>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "command_line.h"
#include "controls.h"
#include "fly_camera.h"
#include "image/exr.h"
#include "image/png.h"
#include "image/tonemap.h"
#include "inspector.h"
#include "interface.h"
#include "kept_settings.h"
#include "panel.h"
#include "passes/tonemap/tonemap.h"
#include "playback.h"
#include "renderer/frame_renderer.h"
#include "renderer/network_file.h"
#include "renderer/reset_rule.h"
#include "scene/camera.h"
#include "scene/movement.h"
#include "stage.h"

namespace limpid::viewer {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr float radiansAPixel = 0.005f;
constexpr float zoomAStep = 0.85f;
constexpr double idleSeconds = 1.0;          ///< between looks at the window while nothing is computed
constexpr double longestStep = 0.1;          ///< seconds that a key moves the camera in one picture
constexpr int restlessPictures = 4;          ///< drawn after the last event: until the panel has settled
constexpr uint64_t framesBetweenTimes = 16;  ///< reading the passes' times waits for the device
constexpr double pathSeconds = 10.0;         ///< of the built-in camera paths
constexpr const char* pathFile = "flown.json";
constexpr std::array<const char*, 3> pathNames{"orbit", "dolly", "shake"};

gpu::DeviceOptions presenting(gpu::DeviceOptions options) {
    options.surfaceExtensions = Window::surfaceExtensions();
    return options;
}

class Viewer {
  public:
    Viewer(const gpu::DeviceOptions& options, TracerChoice tracer, SceneLoader load, scene::Scene first,
           const scene::Camera& home, const ViewSettings& settings);
    void run();

  private:
    void load(const std::string& scene, const std::string& environment);
    void show(scene::Scene scene, const scene::Camera& home);
    void open(const std::string& file);
    void handleInput(double seconds);
    void fly(const ImGuiIO& io, float seconds);
    void applyRequests();
    void applySettings();
    void choosePose();
    bool isFree() const { return panel_.camera == 0; }
    bool settingsDiffer() const;
    bool mustRender();
    void render();
    void makeRenderer();
    void present();
    bool inspect();
    std::string probeOf(const image::Image& picture) const;
    void measureExposure();
    void writeScreenshot(const fs::path& file);
    void copyCommand();
    void savePath();
    void keep();
    void writeControls();
    FlyCamera startCamera() const;
    scene::Camera cameraNow() const;
    scene::CameraKey keyNow() const;
    std::string cameraOption() const;
    /// Runs what may fail for reasons of the user's; says so in the panel.
    template <typename Function>
    void attempt(const Function& function);

    ViewSettings settings_;
    TracerChoice tracer_;
    SceneLoader load_;
    Window window_;
    gpu::Device device_;
    std::unique_ptr<Stage> stage_;
    gpu::Presenter presenter_;
    Interface interface_;
    scene::Camera home_;
    FlyCamera camera_;
    Playback playback_;
    PanelState panel_;
    PanelState used_;  ///< by the last frame
    PanelFacts facts_;
    Controls controls_;
    std::string controlsText_;  ///< as last written
    std::optional<scene::CameraPath> path_;
    std::optional<FrameRenderer> renderer_;
    Inspector inspector_;
    std::vector<std::pair<std::string, image::Image>> images_;  ///< of the pass that is inspected
    std::tuple<uint64_t, std::string, int, InspectorView> inspected_;
    CameraParams lastCamera_{};
    bool networkIsHalf_ = true;
    float speed_ = 1.0f;  ///< world units a second
    uint64_t launchesOfMean_ = 0;
    uint64_t rendered_ = 0;    ///< frames, ever
    uint64_t sameFrames_ = 0;  ///< since something changed
};

Viewer::Viewer(const gpu::DeviceOptions& options, TracerChoice tracer, SceneLoader load, scene::Scene first,
               const scene::Camera& home, const ViewSettings& settings)
    : settings_(settings),
      tracer_(std::move(tracer)),
      load_(std::move(load)),
      window_("Limpid", settings.render.extent),
      device_(presenting(options)),
      presenter_(device_, [this](void* instance) { return window_.makeSurface(instance); }),
      interface_(window_, presenter_),
      camera_(scene::Camera{}, 1.0f) {
    panel_.render = settings.render;
    panel_.samples = settings.samples;
    panel_.maxSamples = static_cast<int>(std::min<uint64_t>(settings.maxSamples, 1 << 20));
    panel_.shrink = settings.shrink;
    facts_.device = device_.info().name;
    show(std::move(first), home);
}

/// Leaves everything as it was if the scene cannot be had. What the command line says of camera and clip is
/// of its own scene.
void Viewer::load(const std::string& name, const std::string& environment) {
    scene::Scene scene = load_(name, environment);
    if (!scene.rig.clips.empty()) scene::chooseClip(scene, "");
    const scene::Camera home = scene.cameras.front();
    show(std::move(scene), home);
    settings_.scene = name;
    settings_.environment = environment;
    settings_.startCamera.clear();
}

void Viewer::show(scene::Scene scene, const scene::Camera& home) {
    auto stage = std::make_unique<Stage>(device_, std::move(scene), tracer_(device_));
    device_.waitIdle();
    renderer_.reset();
    stage_ = std::move(stage);
    window_.setTitle("Limpid: " + stage_->scene().name);
    home_ = home;
    path_.reset();
    facts_.cameras = {"free"};
    for (const scene::Camera& camera : stage_->scene().cameras) facts_.cameras.push_back(camera.name);
    facts_.cameras.insert(facts_.cameras.end(), pathNames.begin(), pathNames.end());
    speed_ = 0.25f * stage_->sphere().radius;
    panel_.asked.measureExposure = panel_.asked.resetCamera = true;
    playback_.reset(0.0);
}

/// An environment is put around the scene that there is; anything else is a scene.
void Viewer::open(const std::string& file) {
    const std::string extension = fs::path(file).extension().string();
    if (extension == ".hdr" || extension == ".exr" || extension == ".pic")
        load(settings_.scene, file);
    else
        load(file, settings_.environment);
    facts_.message = "opened " + file;
}

template <typename Function>
void Viewer::attempt(const Function& function) {
    try {
        facts_.fault.clear();
        function();
    } catch (const Error& fault) {
        facts_.fault = fault.what();
        log::warn("{}", fault.what());
    }
}

/// Around the middle of the scene, as far as it lies ahead.
FlyCamera Viewer::startCamera() const {
    const scene::BoundingSphere& sphere = stage_->sphere();
    const vec3 eye(home_.toWorld[3]), ahead = -vec3(home_.toWorld[2]);
    return {home_, std::max(glm::dot(sphere.center - eye, ahead), 0.25f * sphere.radius)};
}

scene::Camera Viewer::cameraNow() const {
    const auto number = static_cast<size_t>(panel_.camera);
    if (isFree()) return camera_.camera();
    if (path_) return path_->at(playback_.time());
    return scene::cameraAt(stage_->scene(), stage_->scene().cameras[number - 1], playback_.time());
}

scene::CameraKey Viewer::keyNow() const {
    scene::CameraKey key;
    key.eye = camera_.eye();
    key.target = camera_.eye() + camera_.forward();  // as FlyCamera::camera() has it
    key.verticalFov = glm::radians(panel_.fovDegrees);
    return key;
}

std::string Viewer::cameraOption() const {
    if (isFree()) return {};
    if (!path_) return fmt::format("--camera {}", panel_.camera - 1);
    const std::string start = settings_.startCamera.empty() ? "" : settings_.startCamera + " ";
    return start + "--camera-path " + facts_.cameras[static_cast<size_t>(panel_.camera)];
}

void Viewer::handleInput(double seconds) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto pressed = [&](int key) { return !io.WantTextInput && ImGui::IsKeyPressed(key, false); };
    if (pressed(GLFW_KEY_ESCAPE)) window_.close();
    if (pressed(GLFW_KEY_TAB)) panel_.shown = !panel_.shown;
    if (pressed(GLFW_KEY_SPACE)) panel_.running = !panel_.running;
    if (!io.WantCaptureMouse) fly(io, static_cast<float>(seconds));
}

void Viewer::fly(const ImGuiIO& io, float seconds) {
    const float x = io.MouseDelta.x, y = io.MouseDelta.y;
    const bool left = ImGui::IsMouseDown(ImGuiMouseButton_Left),
               right = ImGui::IsMouseDown(ImGuiMouseButton_Right),
               middle = ImGui::IsMouseDown(ImGuiMouseButton_Middle);
    const bool moves = ((left || middle) && (x != 0.0f || y != 0.0f)) || right || io.MouseWheel != 0.0f;
    if (moves && !isFree()) {
        // From where it is.
        const scene::Camera here = cameraNow();
        camera_ = FlyCamera(here, camera_.distance());
        panel_.fovDegrees = glm::degrees(here.verticalFov);
        panel_.camera = 0;
        path_.reset();
        playback_.reset(playback_.time());
        renderer_.reset();
    }
    if (left) camera_.orbit(radiansAPixel * x, -radiansAPixel * y);
    if (middle) camera_.pan(x / io.DisplaySize.y, -y / io.DisplaySize.y);
    if (right) {
        camera_.look(radiansAPixel * x, -radiansAPixel * y);
        if (io.MouseWheel != 0.0f) speed_ *= std::pow(1.0f / zoomAStep, io.MouseWheel);
        const auto axis = [&](int more, int less) {
            return (ImGui::IsKeyDown(more) ? 1.0f : 0.0f) - (ImGui::IsKeyDown(less) ? 1.0f : 0.0f);
        };
        camera_.move(
            speed_ * seconds *
            vec3(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S)));
    } else if (io.MouseWheel != 0.0f) {
        camera_.zoom(std::pow(zoomAStep, io.MouseWheel));
    }
}

void Viewer::choosePose() {
    const size_t cameras = stage_->scene().cameras.size();
    const auto number = static_cast<size_t>(panel_.camera);
    path_.reset();
    if (number > cameras) {
        const double seconds = std::max(stage_->duration(), pathSeconds);
        path_ = scene::builtinCameraPath(facts_.cameras[number], stage_->scene(), home_, seconds);
        panel_.playing = true;
    }
    if (number == 0) camera_ = startCamera();
    playback_.reset(playback_.time());
    renderer_.reset();
}

/// What the panel asked for.
void Viewer::applyRequests() {
    PanelRequests& asked = panel_.asked;
    if (std::exchange(asked.open, false)) attempt([&] { open(panel_.file); });
    for (const std::string& file : window_.takeDropped()) attempt([&] { open(file); });
    if (std::exchange(asked.resetCamera, false)) {
        panel_.camera = 0;
        panel_.fovDegrees = glm::degrees(home_.verticalFov);
        choosePose();
    }
    if (std::exchange(asked.choosePose, false)) choosePose();
    if (std::exchange(asked.seek, false)) playback_.seek(double{panel_.time});
    if (std::exchange(asked.reset, false)) {
        playback_.reset(playback_.time());
        renderer_.reset();
    }
    if (asked.measureExposure && renderer_ && playback_.frames() > 0) {
        asked.measureExposure = false;
        measureExposure();
    }
    if (std::exchange(asked.command, false)) attempt([&] { copyCommand(); });
    if (std::exchange(asked.savePath, false)) attempt([&] { savePath(); });
    if (std::exchange(asked.screenshot, false) && renderer_) attempt([&] { writeScreenshot("limpid.png"); });
}

/// Settings that follow from others. Those of what cannot be done go back to what was.
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
        render.jitter = render.pipeline.accumulates() ? Jitter::Pixel : Jitter::Off;
    camera_.setVerticalFov(glm::radians(panel_.fovDegrees));
    playback_.playing = panel_.playing && (stage_->moves() || path_);
    facts_.duration = path_ ? std::max(stage_->duration(), pathSeconds) : stage_->duration();
    if (facts_.duration > 0.0 && playback_.time() > facts_.duration) playback_.seek(0.0);
    panel_.time = static_cast<float>(playback_.time());
    const denoise::Denoiser* const denoiser = render.pipeline.denoiser;
    const bool half = render.denoisers.kpcn.half;
    if (!denoiser || !denoiser->network || (render.denoisers.kpcn.network && half == networkIsHalf_)) return;
    attempt([&] { loadNetwork(device_, denoiser, settings_.weights, render.denoisers); });
    networkIsHalf_ = half;
    if (!render.denoisers.kpcn.network) render.pipeline = used_.render.pipeline;
}

/// Other settings than those of the last frame, as far as they make another picture.
bool Viewer::settingsDiffer() const {
    if (!renderer_ || panel_.samples != used_.samples || panel_.exposure != used_.exposure) return true;
    if (!panel_.render.pipeline.accumulates()) return panel_.render != used_.render;
    return mustReset({lastCamera_, used_.render}, {lastCamera_, panel_.render});
}

/// Whether the next picture would be another one, and is wanted.
bool Viewer::mustRender() {
    const gpu::Extent extent = panel_.render.extent;
    if (extent.width == 0 || extent.height == 0) return false;
    const CameraParams now = scene::cameraParams(cameraNow(), extent.width, extent.height);
    const bool moved = !sameCamera(now, lastCamera_);
    if (std::exchange(panel_.asked.step, false)) return true;
    if (settingsDiffer()) {
        sameFrames_ = 0;
        return true;
    }
    if (!panel_.running) return false;
    if (moved || (stage_->moves() && playback_.change()) || (path_ && playback_.playing)) {
        sameFrames_ = 0;
        return true;
    }
    if (settings_.quitAfter > 0) return true;
    const uint64_t samples =
        panel_.render.pipeline.accumulates() ? renderer_->samplesInMean() : sameFrames_ * panel_.samples;
    return samples < static_cast<uint64_t>(panel_.maxSamples);
}

void Viewer::makeRenderer() {
    if (renderer_ && panel_.samples == used_.samples) return;
    renderer_.emplace(device_, stage_->onDevice(), panel_.render, panel_.samples);
    launchesOfMean_ = 0;
    playback_.reset(playback_.time());
    renderer_->setDisplay([this](gpu::FrameGraph& graph, const FrameImages& images) {
        if (images.beauty) return tonemap(graph, images.beauty, panel_.exposure);
        return tonemap(graph, images.diffuse, panel_.exposure, images.emission);
    });
}

void Viewer::render() {
    const auto began = Clock::now();
    const bool changed =
        renderer_ && (panel_.render != used_.render || panel_.fovDegrees != used_.fovDegrees);
    makeRenderer();
    if (renderer_->setSettings(panel_.render))
        playback_.reset(playback_.time());
    else if (changed)
        playback_.noteOtherSettings();
    const gpu::Extent extent = panel_.render.extent;
    const CameraParams camera = scene::cameraParams(cameraNow(), extent.width, extent.height);
    Moment moment = playback_.moment(camera);
    if (stage_->moves()) {
        if (const auto change = playback_.change()) moment.scene = stage_->frame(change->to, change->from);
    }
    if (panel_.render.pipeline.accumulates()) {
        // A mean that starts anew starts with the first random numbers, so that it can be made again.
        if (moment.scene || mustReset({lastCamera_, used_.render}, {camera, panel_.render}))
            launchesOfMean_ = 0;
        moment.number = launchesOfMean_++;
    }
    used_ = panel_;
    lastCamera_ = camera;
    renderer_->render(std::move(moment));
    playback_.advance(camera, keyNow());
    ++rendered_;
    ++sameFrames_;
    if (std::exchange(panel_.asked.measureExposure, false)) measureExposure();
    facts_.samplesInMean = panel_.render.pipeline.accumulates() ? renderer_->samplesInMean() : 0;
    facts_.frames = playback_.frames();
    if (rendered_ % framesBetweenTimes != 1) return;
    facts_.passes = renderer_->passTimes();
    facts_.frameMilliseconds = std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

void Viewer::measureExposure() {
    panel_.exposure = image::autoExposure(beautyOf(renderer_->download()));
}

void Viewer::writeScreenshot(const fs::path& file) {
    const RenderedLayers layers = renderer_->download();
    if (file.extension() == ".exr") {
        image::writeExr(file, toLayeredImage(layers, {}, image::Storage::Float));
    } else {
        image::writePng(file, image::toBytes(image::tonemap(beautyOf(layers), panel_.exposure)));
    }
    facts_.message = "wrote " + file.string();
    log::info("wrote {}", file.string());
}

void Viewer::copyCommand() {
    if (!renderer_ || playback_.frames() == 0) throw Error("there is no frame yet");
    if (isFree() && home_.orthographic)
        throw Error("the command line has no orthographic camera of one's own");
    const scene::Scene& scene = stage_->scene();
    ShownFrame frame{.scene = settings_.scene,
                     .environment = settings_.environment,
                     .clip = stage_->moves() ? scene.rig.clips[static_cast<size_t>(scene.clip)].name : "",
                     .weights = settings_.weights.string(),
                     .settings = used_.render,
                     .samples = used_.samples,
                     .samplesInMean = renderer_->samplesInMean(),
                     .camera = cameraOption(),
                     .fovDegrees = used_.fovDegrees};
    const CommandLine command = commandLineOf(frame, playback_, pathFile);
    if (!command.problem.empty()) throw Error(command.problem);
    if (command.needsPath) writeTextAtomically(pathFile, pathText(playback_, used_.fovDegrees));
    window_.setClipboard(command.text);
    facts_.message = command.text;
    log::info("{}", command.text);
}

void Viewer::savePath() {
    if (!isFree()) throw Error("only what the hand has flown can be saved");
    if (playback_.cameras().empty()) throw Error("nothing was flown since the last reset, or too much");
    writeTextAtomically(pathFile, pathText(playback_, used_.fovDegrees));
    facts_.message =
        fmt::format("wrote {}: {} frames, for --camera-path", pathFile, playback_.cameras().size());
}

void Viewer::keep() {
    ViewSettings settings = settings_;
    settings.render = panel_.render;
    settings.samples = panel_.samples;
    settings.maxSamples = static_cast<uint64_t>(panel_.maxSamples);
    settings.shrink = panel_.shrink;
    keepSettings(settings_.kept, settings);
}

/// Whenever something is elsewhere.
void Viewer::writeControls() {
    if (settings_.controls.empty()) return;
    const std::string text =
        fmt::format("frames\t{}\nsamples\t{}\nfault\t{}\nmessage\t{}\nprobe\t{}\n", facts_.frames,
                    facts_.samplesInMean, facts_.fault, facts_.message, facts_.probe) +
        controls_.text();
    if (text == controlsText_) return;
    controlsText_ = text;
    writeTextAtomically(settings_.controls, text);
}

/// Whether an image of a pass is shown instead of the picture.
bool Viewer::inspect() {
    if (panel_.pass.empty() || !renderer_ || rendered_ == 0) return false;
    const auto wanted = std::tuple(rendered_, panel_.pass, panel_.image, panel_.view);
    if (wanted != inspected_) {
        try {
            images_ = renderer_->dump(panel_.pass);
        } catch (const UsageError&) {  // of another pipeline
            panel_.pass.clear();
            return false;
        }
        facts_.images.clear();
        for (const auto& [name, picture] : images_) facts_.images.push_back(name);
        panel_.image = std::min(panel_.image, static_cast<int>(images_.size()) - 1);
        inspector_.show(device_, images_[static_cast<size_t>(panel_.image)].second, panel_.view);
        inspected_ = wanted;
    }
    facts_.probe = probeOf(images_[static_cast<size_t>(panel_.image)].second);
    return true;
}

std::string Viewer::probeOf(const image::Image& picture) const {
    const ImGuiIO& io = ImGui::GetIO();
    const auto along = [](float mouse, float window, uint32_t pixels) {
        return static_cast<uint32_t>(std::clamp(mouse / std::max(window, 1.0f), 0.0f, 0.9999f) *
                                     static_cast<float>(pixels));
    };
    const uint32_t x = along(io.MousePos.x, io.DisplaySize.x, picture.width),
                   y = along(io.MousePos.y, io.DisplaySize.y, picture.height);
    std::string text = fmt::format("({}, {}):", x, y);
    for (uint32_t c = 0; c < picture.components; ++c) text += fmt::format(" {:.5g}", picture.at(x, y, c));
    return text;
}

void Viewer::present() {
    const bool inspects = inspect();
    const gpu::Overlay overlay = interface_.end();
    if (inspects)
        presenter_.present(inspector_.graph(), inspector_.shown(), window_.pixels(), overlay);
    else if (renderer_ && renderer_->displayed())
        presenter_.present(renderer_->graph(), renderer_->displayed(), window_.pixels(), overlay);
}

void Viewer::run() {
    auto last = Clock::now();
    int restless = restlessPictures;
    while (!window_.closed() && (settings_.quitAfter == 0 || rendered_ < settings_.quitAfter)) {
        if (window_.poll(restless > 0 ? 0.0 : idleSeconds)) restless = restlessPictures;
        if (!window_.input().empty()) restless = restlessPictures;
        if (restless == 0) continue;
        interface_.begin();
        const auto now = Clock::now();
        handleInput(std::min(std::chrono::duration<double>(now - last).count(), longestStep));
        last = now;
        drawPanel(panel_, facts_, controls_);
        applyRequests();
        applySettings();
        --restless;
        if (mustRender()) {
            render();
            restless = restlessPictures;
        }
        writeControls();
        present();
    }
    if (renderer_ && !settings_.screenshot.empty()) writeScreenshot(settings_.screenshot);
    attempt([&] { keep(); });
    device_.waitIdle();
    if (device_.validationMessages() > 0)
        throw Error(fmt::format("the validation layer reported {} messages", device_.validationMessages()));
}

}  // namespace

void view(const gpu::DeviceOptions& device, const TracerChoice& tracer, const SceneLoader& load,
          const std::function<scene::Camera(const scene::Scene&)>& start, const ViewSettings& settings) {
    // Before there is a window: what is wrong with these needs none.
    scene::Scene first = load(settings.scene, settings.environment);
    if (!first.rig.clips.empty()) scene::chooseClip(first, settings.animation);
    const scene::Camera home = start(first);
    Viewer(device, tracer, load, std::move(first), home, settings).run();
}

}  // namespace limpid::viewer
