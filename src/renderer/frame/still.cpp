#include "renderer/frame/still.h"

#include <algorithm>

#include "base/error.h"

namespace limpid {
namespace {

bool isUint(gpu::Format format) {
    return format == gpu::Format::R32Uint || format == gpu::Format::RG32Uint ||
           format == gpu::Format::RGBA32Uint;
}

/// lavapipe ends all loops of an invocation after 65,535 iterations in total; a path in a scene of a million
/// triangles needs some thousands. More samples would silently lose light.
constexpr uint32_t maxSamplesPerCpuLaunch = 4;

void download(gpu::FrameGraph& graph, gpu::Device& device, gpu::ImageHandle image,
              std::vector<float>& pixels) {
    if (image) pixels = graph.downloadFloat(device, image);
}
void download(gpu::FrameGraph& graph, gpu::Device& device, gpu::ImageHandle image,
              std::vector<uint32_t>& pixels) {
    if (image) pixels = graph.downloadUint(device, image);
}

}  // namespace

RenderCounters sumCounters(std::span<const uint32_t> pixels) {
    RenderCounters sum;
    for (size_t i = 0; i + 1 < pixels.size(); i += 2) {
        sum.rays += pixels[i];
        sum.rejected += pixels[i + 1];
    }
    return sum;
}

uint32_t samplesPerLaunch(const gpu::Device& device, const RenderSettings& settings) {
    if (settings.pipeline.takesOneSampleALaunch()) return 1;
    return device.isCpu() ? std::min(settings.samplesPerLaunch, maxSamplesPerCpuLaunch)
                          : settings.samplesPerLaunch;
}

std::vector<std::pair<std::string, image::Image>> imagesOfPass(gpu::FrameGraph& graph, gpu::Device& device,
                                                               const std::string& pass) {
    std::vector<gpu::ImageHandle> handles = graph.imagesWrittenBy(pass);
    if (handles.empty()) {
        std::string names;
        for (const gpu::RecordedPass& recorded : graph.passes()) names += " " + recorded.name;
        throw UsageError("there is no pass '" + pass + "' in this frame; its passes are" + names);
    }
    for (const gpu::ImageHandle previous : graph.previousReadBy(pass)) handles.push_back(previous);
    std::vector<std::pair<std::string, image::Image>> result;
    for (const gpu::ImageHandle handle : handles) {
        const gpu::Extent extent = graph.extent(handle);
        image::Image picture(extent.width, extent.height, gpu::componentCount(graph.format(handle)));
        if (isUint(graph.format(handle))) {
            const std::vector<uint32_t> values = graph.downloadUint(device, handle);
            std::transform(values.begin(), values.end(), picture.pixels.begin(),
                           [](uint32_t v) { return static_cast<float>(v); });
        } else {
            picture.pixels = graph.downloadFloat(device, handle);
        }
        result.emplace_back(graph.name(handle), std::move(picture));
    }
    return result;
}

RenderedLayers downloadLayers(gpu::FrameGraph& graph, gpu::Device& device, const FrameImages& images,
                              uint64_t samples) {
    const gpu::ImageHandle any = images.beauty ? images.beauty : images.diffuse;
    if (!any) throw Error("nothing has been rendered yet");
    RenderedLayers layers;
    layers.extent = graph.extent(any);
    layers.samples = samples;
    download(graph, device, images.beauty, layers.beauty);
    layers.forEach(
        [&](const LayerInfo& layer, auto& pixels) { download(graph, device, images[layer], pixels); });
    return layers;
}

ProgressiveStill::ProgressiveStill(gpu::Device& device, scene::GpuScene& scene, uint64_t maxSamples)
    : device_(device), scene_(scene), maxSamples_(maxSamples) {}

void ProgressiveStill::update(const CameraParams& camera, const RenderSettings& settings,
                              uint64_t sceneVersion) {
    const AccumulationState now{camera, settings, sceneVersion};
    if (frame_ > 0 && mustReset(state_, now)) {
        graph_.resetHistories();
        samples_ = 0;
        frame_ = 0;
    }
    state_ = now;
}

void ProgressiveStill::update(Moment moment, const RenderSettings& settings) {
    if (frame_ > 0) graph_.resetHistories();
    samples_ = 0;
    frame_ = 0;
    state_ = {moment.camera, settings, state_.sceneVersion};
    previousCamera_ = moment.previousCamera;
    moved_ = std::move(moment.scene);
    number_ = moment.number;
}

bool ProgressiveStill::launch() {
    if (samples_ >= maxSamples_) return false;
    FrameInput input{.camera = state_.camera, .previousCamera = previousCamera_.value_or(state_.camera)};
    input.hasPrevious = previousCamera_.has_value();
    input.moved = moved_ ? &*moved_ : nullptr;
    input.firstSample = static_cast<uint32_t>(std::min<uint64_t>(samples_, UINT32_MAX));
    input.stream = number_ * launchesOfAFrame() + frame_;
    input.samplesBefore = samples_;
    input.samples = static_cast<uint32_t>(
        std::min<uint64_t>(samplesPerLaunch(device_, state_.settings), maxSamples_ - samples_));
    graph_.beginFrame();
    images_ = recordFrame(graph_, scene_, state_.settings, input);
    graph_.execute(device_);
    moved_.reset();
    if (frame_ == 0 && images_.ids) ids_ = graph_.downloadUint(device_, images_.ids);
    samples_ += input.samples;
    ++frame_;
    return true;
}

/// Ensures that no two frames of a sequence use the same random numbers.
uint64_t ProgressiveStill::launchesOfAFrame() const {
    return 1 + (maxSamples_ - 1) / samplesPerLaunch(device_, state_.settings);
}

RenderCounters ProgressiveStill::counters() {
    if (frame_ == 0) return {};
    return sumCounters(graph_.downloadUint(device_, images_.counters));
}

RenderedLayers ProgressiveStill::download() {
    if (frame_ == 0) throw Error("nothing has been rendered yet");
    RenderedLayers layers = downloadLayers(graph_, device_, images_, samples_);
    layers.ids = ids_;
    return layers;
}

}  // namespace limpid
