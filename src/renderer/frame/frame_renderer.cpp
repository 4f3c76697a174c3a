#include "renderer/frame/frame_renderer.h"

#include <algorithm>

namespace limpid {
namespace {

/// True if histories can continue. Histories of samples with other settings belong to another picture, but
/// the denoiser's own settings and the camera may change.
bool sameSamples(const RenderSettings& a, const RenderSettings& b) {
    const bool occlusion = a.pipeline.integrator == Integrator::AmbientOcclusion;
    return a.extent == b.extent && a.jitter == b.jitter && a.pipeline == b.pipeline &&
           a.pathtrace == b.pathtrace && (!occlusion || a.ambientOcclusion == b.ambientOcclusion);
}

}  // namespace

FrameRenderer::FrameRenderer(gpu::Device& device, scene::GpuScene& scene, const RenderSettings& settings,
                             uint32_t samples)
    : device_(device),
      scene_(scene),
      settings_(settings),
      samples_(samples),
      filters_(gpu::filterBacking(device)) {}

bool FrameRenderer::setSettings(const RenderSettings& settings) {
    const bool anew = !sameSamples(settings, settings_);
    settings_ = settings;
    if (!anew) return false;
    graph_.resetHistories();
    state_.reset();  // the old mean is lost, even if the settings are restored later
    samplesInMean_ = 0;
    return true;
}

void FrameRenderer::render(Moment moment) {
    FrameInput input{.camera = moment.camera,
                     .previousCamera = moment.previousCamera.value_or(moment.camera)};
    input.hasPrevious = moment.previousCamera.has_value();
    input.moved = moment.scene ? &*moment.scene : nullptr;
    input.launchSamples = samplesPerLaunch(device_, settings_);
    input.filters = filters_;
    if (moment.scene) ++sceneVersion_;
    const uint64_t launches = 1 + (samples_ - 1) / input.launchSamples;
    input.stream = moment.number * launches;
    if (settings_.pipeline.accumulates()) return launchAccumulated(input);
    input.firstSample = static_cast<uint32_t>(std::min<uint64_t>(moment.number * samples_, UINT32_MAX));
    input.samples = samples_;
    launch(input);
}

void FrameRenderer::launchAccumulated(const FrameInput& first) {
    const AccumulationState now{first.camera, settings_, sceneVersion_};
    if (state_ && mustReset(*state_, now)) {
        graph_.resetHistories();
        samplesInMean_ = 0;
    }
    state_ = now;
    FrameInput input = first;
    for (uint32_t done = 0; done < samples_; done += input.samples) {
        input.samples = std::min(first.launchSamples, samples_ - done);
        input.samplesBefore = samplesInMean_;
        input.firstSample = static_cast<uint32_t>(std::min<uint64_t>(samplesInMean_, UINT32_MAX));
        launch(input);
        if (samplesInMean_ == 0)
            ids_ = images_.ids ? graph_.downloadUint(device_, images_.ids) : std::vector<uint32_t>();
        input.moved = nullptr;
        ++input.stream;
        samplesInMean_ += input.samples;
    }
}

void FrameRenderer::launch(FrameInput input) {
    graph_.beginFrame();
    images_ = recordFrame(graph_, scene_, settings_, input);
    if (display_) displayed_ = display_(graph_, images_);
    graph_.execute(device_);
}

std::vector<gpu::PassTime> FrameRenderer::denoisingTimes() {
    std::vector<gpu::PassTime> times = passTimes();
    const size_t others = std::min(images_.firstDenoisingPass.value_or(times.size()), times.size());
    times.erase(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(others));
    return times;
}

uint64_t FrameRenderer::denoisingBytes() const {
    return images_.firstDenoisingPass ? graph_.bytesOfImagesWrittenFrom(*images_.firstDenoisingPass) : 0;
}

RenderedLayers FrameRenderer::download() {
    FrameImages wanted = images_;
    if (!settings_.layers && images_.beauty) {
        wanted = {};
        wanted.beauty = images_.beauty;
        wanted.depth = images_.depth;
    }
    const bool accumulates = settings_.pipeline.accumulates();
    RenderedLayers layers = downloadLayers(graph_, device_, wanted, accumulates ? samplesInMean_ : samples_);
    if (accumulates) layers.ids = ids_;
    return layers;
}

image::Image FrameRenderer::motion() {
    if (!images_.motion) return {};
    const gpu::Extent extent = graph_.extent(images_.motion);
    image::Image motion(extent.width, extent.height, 4);
    motion.pixels = graph_.downloadFloat(device_, images_.motion);
    return motion;
}

RenderCounters FrameRenderer::counters() {
    return images_.counters ? sumCounters(graph_.downloadUint(device_, images_.counters)) : RenderCounters{};
}

denoise::DisocclusionCounts FrameRenderer::disocclusionCounts() {
    return images_.disocclusion
               ? denoise::countDisocclusion(graph_.downloadUint(device_, images_.disocclusion))
               : denoise::DisocclusionCounts{};
}

}  // namespace limpid
