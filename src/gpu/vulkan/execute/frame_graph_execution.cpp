// The FrameGraph functions that need a device.
#include <span>

#include "base/error.h"
#include "base/half.h"
#include "base/text/format.h"
#include "gpu/graph/frame_graph.h"
#include "gpu/graph/frame_graph_impl.h"
#include "gpu/vulkan/device_impl.h"
#include "gpu/vulkan/execute/frame_executor.h"

namespace limpid::gpu {
namespace {

/// `T` divides a texel.
template <typename T>
std::vector<T> downloadAs(FrameGraph& graph, Device& device, ImageHandle handle) {
    const Image& image = graph.downloadable(device, handle);
    std::vector<T> values(uint64_t{image.extent.width} * image.extent.height * bytesPerTexel(image.format) /
                          sizeof(T));
    device.waitIdle();
    device.impl().transfer().download(image, std::as_writable_bytes(std::span(values)));
    return values;
}

template <typename T, typename Convert>
std::vector<float> convertAll(const std::vector<T>& values, Convert convert) {
    std::vector<float> result;
    result.reserve(values.size());
    for (const T value : values) result.push_back(convert(value));
    return result;
}

}  // namespace

FrameExecutor& FrameGraph::Impl::executorFor(Device& device) {
    const std::shared_ptr<const Context>& context = device.impl().context;
    if (!executor) executor = std::make_shared<FrameExecutor>(context, device.impl().pipelines, options);
    if (&executor->context() != context.get())
        throw Error("a frame graph runs on one device only, and this is another");
    return *executor;
}

FrameExecutor& FrameGraph::Impl::executed(Device& device) const {
    if (!executor || !frame.executed) throw Error("the frame has not been executed");
    if (&executor->context() != device.impl().context.get())
        throw Error("the frame was executed on another device");
    return *executor;
}

FrameExecutor& FrameGraph::Impl::readyToRun(Device& device) {
    requireRecording();
    FrameExecutor& runner = executorFor(device);
    for (size_t i = 0; i < frame.dispatches.size(); ++i) {
        for (const BoundResource& resource : frame.dispatches[i].resources) {
            if (resource.buffer && storageOf(*resource.buffer).context.get() != &runner.context()) {
                throw Error(formatText("pass '{}': buffer '{}' belongs to another device",
                                       frame.passes[i].name, resource.buffer->name));
            }
        }
    }
    for (const RecordedUpload& upload : frame.uploads) {
        if (upload.buffer && storageOf(*upload.buffer).context.get() != &runner.context())
            throw Error(formatText("buffer '{}' belongs to another device", upload.buffer->name));
    }
    shareMemory();
    return runner;
}

void FrameGraph::execute(Device& device) {
    FrameExecutor& executor = impl_->readyToRun(device);
    executor.setInterruption(device.isCpu() ? impl_->interrupted : nullptr);
    device.impl().pipelines->prepare(impl_->frame.dispatches);
    executor.execute(impl_->frame);
    impl_->frame.executed = true;
}

void FrameGraph::setInterruption(std::function<bool()> interrupted) {
    impl_->interrupted = std::move(interrupted);
}

void FrameGraph::record(Device& device, VkCommandBuffer commands) {
    FrameExecutor& executor = impl_->readyToRun(device);
    device.impl().pipelines->prepare(impl_->frame.dispatches);
    executor.record(impl_->frame, commands);
    impl_->frame.executed = true;
}

void FrameGraph::clearImages(Device& device, VkCommandBuffer commands) {
    impl_->readyToRun(device).clear(impl_->frame, commands);
}

void FrameGraph::prepare(Device& device) {
    device.impl().pipelines->prepare(impl_->frame.dispatches);
}

bool FrameGraph::isPrepared(Device& device) const {
    return device.impl().pipelines->hasAll(impl_->frame.dispatches);
}

void FrameGraph::prepareBeside(Device& device) {
    device.impl().pipelines->prepareBeside(impl_->frame.dispatches);
}

const Image& FrameGraph::imageOnDevice(Device& device, ImageHandle image) {
    const RecordedImage& recorded = impl_->frame.images[impl_->indexOf(image)];
    return impl_->executed(device).image(recorded);
}

const Image& FrameGraph::downloadable(Device& device, ImageHandle handle) {
    const RecordedImage& recorded = impl_->frame.images[impl_->indexOf(handle)];
    const FrameExecutor& executor = impl_->executed(device);
    if (!recorded.written && recorded.role != RecordedImage::Role::Previous)
        throw Error(formatText("image '{}' cannot be downloaded: no pass wrote it", recorded.name));
    if (recorded.overwritten)
        throw Error(formatText("image '{}' cannot be downloaded: its memory was reused", recorded.name));
    return executor.image(recorded);
}

std::vector<float> FrameGraph::downloadFloat(Device& device, ImageHandle image) {
    switch (format(image)) {
        case Format::R32Float:
        case Format::RG32Float:
        case Format::RGBA32Float:
            return downloadAs<float>(*this, device, image);
        case Format::R16Float:
        case Format::RGBA16Float:
            return convertAll(downloadAs<uint16_t>(*this, device, image), halfToFloat);
        case Format::RGBA8Unorm:
            return convertAll(downloadAs<uint8_t>(*this, device, image),
                              [](uint8_t value) { return static_cast<float>(value) / 255.0f; });
        default:
            throw Error(
                formatText("image '{}' is {}: use downloadUint", name(image), toString(format(image))));
    }
}

std::vector<uint32_t> FrameGraph::downloadUint(Device& device, ImageHandle image) {
    switch (format(image)) {
        case Format::R32Uint:
        case Format::RG32Uint:
        case Format::RGBA32Uint:
        case Format::RGBA8Unorm:
            return downloadAs<uint32_t>(*this, device, image);
        default:
            throw Error(
                formatText("image '{}' is {}: use downloadFloat", name(image), toString(format(image))));
    }
}

std::vector<PassTime> FrameGraph::passTimes(Device& device) {
    if (!impl_->executor) return {};
    if (&impl_->executor->context() != device.impl().context.get()) {
        throw Error("the frames were executed on another device");
    }
    return impl_->executor->passTimes();
}

}  // namespace limpid::gpu
