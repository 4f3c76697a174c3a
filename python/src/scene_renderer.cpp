#include "scene_renderer.h"

#include "base/error.h"
#include "gpu/specialise/specialise.h"
#include "renderer/layers/layers.h"
#include "renderer/method/network_file.h"
#include "renderer/method/parameters.h"
#include "scene/framing/camera_path.h"
#include "scene/model/camera.h"
#include "scene/motion/movement.h"

namespace limpid::python {
namespace {

Jitter jitterOf(const std::string& name, const Pipeline& pipeline) {
    if (name.empty()) return defaultJitter(pipeline);
    for (const Jitter jitter : {Jitter::Pixel, Jitter::Frame, Jitter::Off})
        if (name == toString(jitter)) return jitter;
    throw UsageError("jitter: '" + name + "' is none of pixel, frame and off");
}

RenderSettings settingsOf(const RenderOptions& o) {
    RenderSettings settings;
    settings.extent = {o.width, o.height};
    settings.seed = o.seed;
    settings.samplesPerLaunch = std::min(o.samples, 4u);  // supported by every device
    settings.pipeline = parsePipeline("path", o.denoiser.empty() ? "none" : o.denoiser);
    settings.jitter = jitterOf(o.jitter, settings.pipeline);
    settings.layers = true;
    for (const std::string& text : o.assignments) assign(settings, text);
    if (!settings.pipeline.accumulates() && o.samples > 65536)
        throw UsageError("spp: a frame that is denoised takes 65536 samples at most");
    return settings;
}

scene::Scene sceneOf(const RenderOptions& o) {
    scene::Scene scene = scene::openScene(o.source);
    const bool atRest = o.animation == "none" || (o.animation.empty() && scene.rig.clips.empty());
    if (!atRest) scene::chooseClip(scene, o.animation);
    return scene;
}

scene::Camera cameraOf(const RenderOptions& o, const scene::Scene& scene) {
    const scene::Camera camera = scene::findCamera(scene, o.camera);
    if (o.eye.empty() && o.target.empty() && o.fov == 0.0f) return camera;
    if (o.eye.size() != 3 || o.target.size() != 3)
        throw UsageError("eye and target go together, and fov with them");
    if (!(o.fov >= 0.0f && o.fov < 180.0f))
        throw UsageError("fov: more than 0 and less than 180 degrees are possible");
    const vec3 eye(o.eye[0], o.eye[1], o.eye[2]), target(o.target[0], o.target[1], o.target[2]);
    if (eye == target) throw UsageError("eye and target are the same point");
    return scene::lookAt(eye, target, vec3(0.0f, 1.0f, 0.0f),
                         o.fov > 0.0f ? glm::radians(o.fov) : camera.verticalFov);
}

std::optional<scene::CameraPath> pathOf(const RenderOptions& o, const scene::Scene& scene,
                                        const scene::Camera& camera) {
    if (o.cameraPath.empty()) return std::nullopt;
    if (!scene::isBuiltinCameraPath(o.cameraPath)) return scene::loadCameraPath(o.cameraPath);
    return scene::builtinCameraPath(o.cameraPath, scene, camera, o.timing.timeOf(o.frames));
}

void checkTiming(const SequenceTiming& timing, const Pipeline& pipeline) {
    if (!(timing.framesPerSecond >= 1e-3 && timing.framesPerSecond <= 1e6))
        throw UsageError("fps: 0.001 to 1000000 frames per second are possible");
    if (!(timing.shutter.open >= 0.0 && timing.shutter.open <= 100.0))
        throw UsageError("shutter: 0 to 100 frames are possible");
    if (timing.shutter.isOpen() && !pipeline.accumulates())
        throw UsageError("shutter: denoisers follow sharp surfaces; render without one");
}

}  // namespace

RenderDevice::RenderDevice(const std::string& select)
    : device([&] {
          gpu::DeviceOptions options;
          options.select = select;
          options.specialise = gpu::specialiser();
          return options;
      }()) {}

SceneRenderer::SceneRenderer(std::shared_ptr<RenderDevice> device, const RenderOptions& o)
    : device_(std::move(device)), settings_(settingsOf(o)), samples_(o.samples), scene_(sceneOf(o)) {
    checkTiming(o.timing, settings_.pipeline);
    const std::lock_guard lock(device_->mutex);
    gpu::Device& on = device_->device;
    settings_.networks = loadNetworks(on, settings_.pipeline.denoiser, o.weights, settings_.denoisers);
    const scene::SceneData data = scene::buildSceneData(scene_);
    gpuScene_.emplace(on, data, scene::TraceOptions{scene::automaticTracer(on.info()), {}});
    const scene::Camera camera = cameraOf(o, scene_);
    sequence_.emplace(scene_, data, camera, pathOf(o, scene_, camera), o.timing);
    scene_.textures.clear();  // they are on the device now
    renderer_.emplace(on, *gpuScene_, settings_, o.samples);
}

SceneRenderer::~SceneRenderer() {
    const std::lock_guard lock(device_->mutex);
    renderer_.reset();
    gpuScene_.reset();
}

/// Each sample sees another instant of the open shutter, as in `limpid render --shutter`.
void SceneRenderer::renderBlurred(uint64_t frame, const std::function<void()>& between) {
    for (uint64_t sample = 0; sample < samples_; ++sample) {
        const double instant = shutterInstant(settings_.seed, frame, sample);
        Moment moment = sequence_->momentDuring(frame, instant, settings_.extent);
        if (sample == 0)
            renderer_->begin(std::move(moment));
        else
            renderer_->moveOn(std::move(moment));
        const uint64_t point = frame * samples_ + sample;
        renderer_->launch({.stream = point, .first = sample, .point = point, .alone = samples_ == 1});
        between();
    }
}

RenderedLayers SceneRenderer::renderLayers(uint64_t frame, const std::function<void()>& between) {
    // A frame with a denoiser is a single launch, which takes minutes on a CPU.
    renderer_->graph().setInterruption([between] {
        between();
        return false;
    });
    if (sequence_->isBlurred()) {
        renderBlurred(frame, between);
    } else if (settings_.pipeline.accumulates()) {
        // Frames may come in any order, so each has a mean of its own.
        renderer_->begin(sequence_->moment(frame, settings_.extent));
        while (renderer_->launch()) between();
    } else {
        renderer_->render(sequence_->moment(frame, settings_.extent));
    }
    return renderer_->download();
}

std::pair<image::LayeredImage, CameraParams> SceneRenderer::render(uint64_t frame,
                                                                   const std::function<void()>& between) {
    const std::lock_guard lock(device_->mutex);
    const CameraParams camera = sequence_->camera(frame, settings_.extent);
    const RenderedLayers layers = renderLayers(frame, between);
    return {toLayeredImage(layers, settings_.pipeline.layers(), image::Storage::Float), camera};
}

}  // namespace limpid::python
