#include "viewer.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <chrono>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/log.h"
#include "fly_camera.h"
#include "image/png.h"
#include "image/tonemap.h"
#include "interface.h"
#include "panel.h"
#include "passes/tonemap/tonemap.h"
#include "renderer/frame_renderer.h"
#include "renderer/network_file.h"
#include "scene/camera.h"
#include "scene/framing.h"
#include "scene/gpu_scene.h"

namespace limpid::viewer {
namespace {

using Clock = std::chrono::steady_clock;

constexpr float radiansAPixel = 0.005f;
constexpr float zoomAStep = 0.85f;
constexpr double idleSeconds = 0.5;          ///< between looks at the window while nothing is computed
constexpr uint64_t framesBetweenTimes = 16;  ///< reading the passes' times waits for the device

class Viewer {
  public:
    Viewer(const gpu::DeviceOptions& options, const TracerChoice& tracer, scene::Scene scene,
           const scene::Camera& camera, const ViewSettings& settings);
    void run();

  private:
    void handleInput(double seconds);
    void applyChanges();
    bool mustRender();
    void render();
    void show();
    void measureExposure();
    void writeScreenshot(const std::filesystem::path& file);
    FlyCamera startCamera() const;

    ViewSettings settings_;
    scene::Scene scene_;
    scene::Camera start_;
    Window window_;
    gpu::Device device_;
    scene::GpuScene gpuScene_;
    gpu::Presenter presenter_;
    Interface interface_;
    FlyCamera camera_;
    PanelState panel_;
    PanelState used_;  ///< by the last frame
    PanelFacts facts_;
    std::optional<FrameRenderer> renderer_;
    std::optional<CameraParams> previousCamera_;
    CameraParams lastCamera_{};
    float speed_ = 1.0f;  ///< world units a second
    uint64_t frames_ = 0;
};

gpu::DeviceOptions presenting(gpu::DeviceOptions options) {
    options.surfaceExtensions = Window::surfaceExtensions();
    return options;
}

Viewer::Viewer(const gpu::DeviceOptions& options, const TracerChoice& tracer, scene::Scene scene,
               const scene::Camera& camera, const ViewSettings& settings)
    : settings_(settings),
      scene_(std::move(scene)),
      start_(camera),
      window_("Limpid: " + scene_.name, settings.render.extent),
      device_(presenting(options)),
      gpuScene_(device_, scene::buildSceneData(scene_), {tracer(device_), {}}),
      presenter_(device_, [this](void* instance) { return window_.makeSurface(instance); }),
      interface_(window_, presenter_),
      camera_(startCamera()) {
    panel_.render = settings.render;
    panel_.samples = settings.samples;
    panel_.verticalFov = start_.verticalFov;
    panel_.measureExposure = true;
    facts_.device = device_.info().name;
    speed_ = 0.25f * scene::boundingSphere(scene_).radius;
}

/// Around the middle of the scene, as far as it lies ahead.
FlyCamera Viewer::startCamera() const {
    const scene::BoundingSphere sphere = scene::boundingSphere(scene_);
    const vec3 eye(start_.toWorld[3]), ahead = -vec3(start_.toWorld[2]);
    return {start_, std::max(glm::dot(sphere.center - eye, ahead), 0.25f * sphere.radius)};
}

void Viewer::handleInput(double seconds) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!io.WantCaptureKeyboard) {
        if (ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false)) window_.close();
        if (ImGui::IsKeyPressed(GLFW_KEY_TAB, false)) panel_.shown = !panel_.shown;
    }
    if (io.WantCaptureMouse) return;
    const float x = io.MouseDelta.x, y = io.MouseDelta.y;
    if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) camera_.orbit(radiansAPixel * x, -radiansAPixel * y);
    if (ImGui::IsMouseDown(ImGuiMouseButton_Middle)) camera_.pan(x / io.DisplaySize.y, -y / io.DisplaySize.y);
    if (ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
        camera_.look(radiansAPixel * x, -radiansAPixel * y);
        if (io.MouseWheel != 0.0f) speed_ *= std::pow(1.0f / zoomAStep, io.MouseWheel);
        const auto axis = [&](int more, int less) {
            return (ImGui::IsKeyDown(more) ? 1.0f : 0.0f) - (ImGui::IsKeyDown(less) ? 1.0f : 0.0f);
        };
        camera_.move(
            speed_ * static_cast<float>(seconds) *
            vec3(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S)));
    } else if (io.MouseWheel != 0.0f) {
        camera_.zoom(std::pow(zoomAStep, io.MouseWheel));
    }
}

/// What the panel asked for; the settings of what cannot be done go back to what was.
void Viewer::applyChanges() {
    if (std::exchange(panel_.resetCamera, false)) {
        camera_ = startCamera();
        panel_.verticalFov = start_.verticalFov;
    }
    camera_.setVerticalFov(panel_.verticalFov);
    panel_.render.extent = window_.pixels();
    const denoise::Denoiser* const denoiser = panel_.render.pipeline.denoiser;
    const bool half = panel_.render.denoisers.kpcn.half;
    if (denoiser && denoiser->network &&
        (!panel_.render.denoisers.kpcn.network || half != used_.render.denoisers.kpcn.half)) {
        try {
            loadNetwork(device_, denoiser, settings_.weights, panel_.render.denoisers);
        } catch (const Error& fault) {
            facts_.fault = fault.what();
            panel_.render = used_.render;
        }
    }
}

/// Whether the next picture would be another one.
bool Viewer::mustRender() {
    if (panel_.render.extent.width == 0 || panel_.render.extent.height == 0) return false;
    if (!renderer_ || panel_.render != used_.render || panel_.samples != used_.samples ||
        panel_.exposure != used_.exposure)
        return true;
    const CameraParams now =
        scene::cameraParams(camera_.camera(), panel_.render.extent.width, panel_.render.extent.height);
    if (now.origin != lastCamera_.origin || now.forward != lastCamera_.forward || now.up != lastCamera_.up)
        return true;
    return !panel_.render.pipeline.accumulates() || renderer_->samplesInMean() < settings_.maxSamples;
}

void Viewer::render() {
    const auto began = Clock::now();
    if (!renderer_ || panel_.samples != used_.samples) {
        renderer_.emplace(device_, gpuScene_, panel_.render, panel_.samples);
        previousCamera_.reset();
        renderer_->setDisplay([this](gpu::FrameGraph& graph, const FrameImages& images) {
            if (images.beauty) return tonemap(graph, images.beauty, panel_.exposure);
            return tonemap(graph, images.diffuse, panel_.exposure, images.emission);
        });
    }
    if (panel_.render.extent != used_.render.extent) previousCamera_.reset();
    renderer_->setSettings(panel_.render);
    used_ = panel_;
    lastCamera_ =
        scene::cameraParams(camera_.camera(), panel_.render.extent.width, panel_.render.extent.height);
    renderer_->render(
        {.camera = lastCamera_, .previousCamera = previousCamera_, .scene = {}, .number = frames_});
    previousCamera_ = lastCamera_;
    ++frames_;
    if (std::exchange(panel_.measureExposure, false)) measureExposure();
    facts_.samplesInMean = panel_.render.pipeline.accumulates() ? renderer_->samplesInMean() : 0;
    if (frames_ % framesBetweenTimes != 1) return;
    facts_.passes = renderer_->passTimes();
    facts_.frameMilliseconds = std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

void Viewer::measureExposure() {
    panel_.exposure = image::autoExposure(beautyOf(renderer_->download()));
}

void Viewer::writeScreenshot(const std::filesystem::path& file) {
    try {
        const image::Image picture = image::tonemap(beautyOf(renderer_->download()), panel_.exposure);
        image::writePng(file, image::toBytes(picture));
        log::info("wrote {}", file.string());
    } catch (const Error& fault) {
        facts_.fault = fault.what();
    }
}

void Viewer::show() {
    const gpu::Overlay overlay = interface_.end();
    if (renderer_ && renderer_->displayed())
        presenter_.present(renderer_->graph(), renderer_->displayed(), window_.pixels(), overlay);
}

void Viewer::run() {
    auto last = Clock::now();
    bool idle = false;
    while (!window_.closed() && (settings_.quitAfter == 0 || frames_ < settings_.quitAfter)) {
        window_.poll(idle ? idleSeconds : 0.0);
        interface_.begin();
        const auto now = Clock::now();
        handleInput(std::chrono::duration<double>(now - last).count());
        last = now;
        drawPanel(panel_, facts_);
        applyChanges();
        idle = !mustRender();
        if (!idle) render();
        if (std::exchange(panel_.screenshot, false) && renderer_) writeScreenshot("limpid.png");
        show();
    }
    if (renderer_ && !settings_.screenshot.empty()) writeScreenshot(settings_.screenshot);
    device_.waitIdle();
    if (device_.validationMessages() > 0)
        throw Error(fmt::format("the validation layer reported {} messages", device_.validationMessages()));
}

}  // namespace

void view(const gpu::DeviceOptions& device, const TracerChoice& tracer, scene::Scene scene,
          const scene::Camera& camera, const ViewSettings& settings) {
    Viewer(device, tracer, std::move(scene), camera, settings).run();
}

}  // namespace limpid::viewer
