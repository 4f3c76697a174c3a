#include "renderer/frame/frame_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "base/error.h"
#include "passes/sobol_points.h"

namespace limpid {
namespace {

/// True if histories can continue. Histories of samples with other settings belong to another picture, but
/// the denoiser's own settings and the camera may change.
bool sameSamples(const RenderSettings& a, const RenderSettings& b) {
    const bool occlusion = a.pipeline.integrator == Integrator::AmbientOcclusion;
    return a.extent == b.extent && a.jitter == b.jitter && a.pipeline == b.pipeline &&
           a.pathtrace == b.pathtrace && (!occlusion || a.ambientOcclusion == b.ambientOcclusion);
}

/// lavapipe ends all loops of an invocation after 65,535 iterations in total; a path in a scene of a million
/// triangles needs some thousands. More samples would silently lose light.
constexpr uint32_t maxSamplesPerCpuLaunch = 4;

}  // namespace

uint32_t samplesPerLaunch(const gpu::Device& device, const RenderSettings& settings) {
    if (settings.pipeline.takesOneSampleALaunch()) return 1;
    uint32_t samples = settings.samplesPerLaunch;
    if (settings.pathtrace.sampler() == Sampler::Sobol) samples = std::min(samples, maxSobolSamplesPerLaunch);
    return device.isCpu() ? std::min(samples, maxSamplesPerCpuLaunch) : samples;
}

FrameRenderer::FrameRenderer(gpu::Device& device, scene::GpuScene& scene, const RenderSettings& settings,
                             uint64_t samples)
    : device_(device),
      scene_(scene),
      settings_(settings),
      samples_(samples),
      filters_(gpu::filterChoice(device)) {}

bool FrameRenderer::setSettings(const RenderSettings& settings) {
    const bool anew = !sameSamples(settings, settings_);
    settings_ = settings;
    if (!anew) return false;
    restart();  // the old mean is lost, even if the settings are restored later
    return true;
}

void FrameRenderer::restart() {
    graph_.resetHistories();
    samplesInMean_ = 0;
}

void FrameRenderer::goTo(Moment moment) {
    moment_ = std::move(moment);
    if (moment_.scene) ++sceneVersion_;
    state_ = {moment_.camera, settings_, sceneVersion_};
    launches_ = samplesLaunched_ = 0;
}

void FrameRenderer::begin(Moment moment) {
    goTo(std::move(moment));
    restart();
    images_ = {};
}

void FrameRenderer::render(Moment moment) {
    const AccumulationState before = state_;
    goTo(std::move(moment));
    if (samplesInMean_ > 0 && mustReset(before, state_)) restart();
    while (launch()) continue;
}

void FrameRenderer::plan(Moment moment) {
    begin(std::move(moment));
    record(nextSamples());
}

bool FrameRenderer::launch() {
    if (samplesLaunched_ >= samples_) return false;
    launch(nextSamples());
    return true;
}

LaunchSamples FrameRenderer::nextSamples() const {
    const uint32_t most = samplesPerLaunch(device_, settings_);
    const uint64_t launchesOfAFrame = 1 + (samples_ - 1) / most;
    LaunchSamples taken{.stream = moment_.number * launchesOfAFrame + launches_,
                        .point = moment_.number * samples_ + samplesLaunched_,
                        .alone = samples_ == 1 && samplesInMean_ == 0};
    if (settings_.pipeline.accumulates()) {
        taken.first = samplesInMean_;
        taken.count = static_cast<uint32_t>(std::min<uint64_t>(most, samples_ - samplesLaunched_));
    } else {
        taken.first = moment_.number * samples_;
        taken.count = static_cast<uint32_t>(samples_);
    }
    return taken;
}

void FrameRenderer::record(const LaunchSamples& taken) {
    FrameInput input{.camera = moment_.camera,
                     .previousCamera = moment_.previousCamera.value_or(moment_.camera)};
    input.hasPrevious = moment_.previousCamera.has_value();
    input.moved = moment_.scene ? &*moment_.scene : nullptr;
    // Frames whose means restart go through other points of the pixel, as those of denoisers do.
    if (samplesInMean_ == 0 && settings_.pipeline.accumulates())
        firstPoint_ = settings_.jitter == Jitter::Frame ? moment_.number * samples_ : 0;
    input.firstSample = static_cast<uint32_t>(std::min<uint64_t>(firstPoint_ + taken.first, UINT32_MAX));
    // Textures are filtered less the more rays share a pixel. Those of earlier frames, which the jitter's
    // points count, do not; nor do those of a denoiser's history.
    input.raysBefore = settings_.pipeline.accumulates() ? taken.first : 0;
    input.firstPoint = static_cast<uint32_t>(taken.point);  // modulo 2^32, like streams of random numbers
    input.jitterSpan = jitterSpanOf(taken.alone ? 1 : 2);
    input.stream = taken.stream;
    input.samplesBefore = samplesInMean_;
    input.samples = taken.count;
    input.launchSamples = samplesPerLaunch(device_, settings_);
    input.filters = filters_;
    input.reasons = reasons_;
    graph_.beginFrame();
    images_ = recordFrame(graph_, scene_, settings_, input);
    if (display_) displayed_ = display_(graph_, images_);
}

/// Some methods keep more in a buffer than others do in images.
void FrameRenderer::checkBuffers() const {
    const uint64_t needed = graph_.largestBufferBytes(), most = device_.maxStorageBufferBytes();
    if (needed > most)
        throw UsageError(
            fmt::format("{}x{} pixels are too many for the denoiser '{}' on {}: a buffer would take {} "
                        "bytes, and the device allows {}",
                        settings_.extent.width, settings_.extent.height, nameOf(settings_.pipeline.denoiser),
                        device_.info().name, needed, most));
}

void FrameRenderer::launch(const LaunchSamples& taken) {
    record(taken);
    checkBuffers();
    graph_.execute(device_);
    scene_.setLightDistancesStale(false);  // unless execute() throws Interrupted
    moment_.scene.reset();                 // the device keeps this state until the next frame
    ++launches_;
    samplesLaunched_ += taken.count;
    if (!settings_.pipeline.accumulates()) return;
    samplesInMean_ += taken.count;
    // Only sample 0 goes through the pixel's centre.
    if (taken.first == 0) readIds();
}

/// Pictures that move need no ids, and should not wait for them.
void FrameRenderer::readIds() {
    ids_.clear();
    idsUnderWay_ = bool(images_.ids);
    if (!idsUnderWay_) return;
    if (!idsReadback_) idsReadback_.emplace(device_);
    idsReadback_->start(graph_, images_.ids);
}

const std::vector<uint32_t>& FrameRenderer::ids() {
    if (std::exchange(idsUnderWay_, false)) {
        const std::span<const std::byte> pixels = idsReadback_->pixels();
        ids_.resize(pixels.size() / sizeof(uint32_t));
        if (!ids_.empty()) std::memcpy(ids_.data(), pixels.data(), pixels.size());
    }
    return ids_;
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
    if (accumulates) layers.ids = ids();
    return layers;
}

image::Image FrameRenderer::motion() {
    if (!images_.motion) return {};
    const gpu::Extent extent = graph_.extent(images_.motion);
    image::Image motion(extent.width, extent.height, 4);
    motion.pixels = graph_.downloadFloat(device_, images_.motion);
    return motion;
}

HistoryReasons FrameRenderer::historyReasons() {
    HistoryReasons result;
    for (const denoise::SignalReasons& reasons : images_.reasons) {
        result.extent = graph_.extent(reasons.image);
        result.signals.push_back({reasons.signal, graph_.downloadUint(device_, reasons.image)});
    }
    return result;
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
