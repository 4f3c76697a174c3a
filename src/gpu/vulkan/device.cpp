#include "gpu/vulkan/device.h"

#include <algorithm>

#include "base/error.h"
#include "base/text/format.h"
#include "gpu/vulkan/device_impl.h"

namespace limpid::gpu {
namespace {

Buffer wrap(std::shared_ptr<BufferStorage> storage) {
    return Buffer(std::move(storage));
}

}  // namespace

std::vector<DeviceInfo> enumerateDevices() {
    const std::unique_ptr<Instance> instance = Instance::create(false);
    std::vector<DeviceInfo> infos;
    if (!instance) return infos;
    for (PhysicalDevice& device : inspectAll(*instance)) infos.push_back(std::move(device.info));
    return infos;
}

Device::Device(const DeviceOptions& options)
    : impl_(std::make_unique<Impl>(std::make_shared<const Context>(options), options)) {}

Device::Device(const AdoptedDevice& adopted)
    : impl_(std::make_unique<Impl>(std::make_shared<const Context>(adopted), DeviceOptions{})) {}

Device::~Device() {
    // For an adopted device this is the caller's job.
    if (impl_->context->submits()) impl_->context->waitIdleNoThrow();
}

const DeviceInfo& Device::info() const {
    return impl_->context->info();
}

uint64_t Device::validationMessages() const {
    return impl_->context->validationMessages();
}

uint64_t Device::allocatedBytes() const {
    return *impl_->context->allocated();
}

uint32_t Device::maxImageSide() const {
    return impl_->context->limits().maxImageDimension2D;
}

uint64_t Device::maxTexelBufferElements() const {
    return impl_->context->limits().maxTexelBufferElements;
}

uint64_t Device::maxAllocationBytes() const {
    return impl_->context->maxAllocation();
}

uint64_t Device::maxBufferBytes() const {
    return impl_->context->maxBufferBytes();
}

uint64_t Device::maxStorageBufferBytes() const {
    return std::min<uint64_t>(maxBufferBytes(), impl_->context->limits().maxStorageBufferRange);
}

Buffer Device::createTexelBuffer(const std::string& name, Format format, std::span<const std::byte> data) {
    const uint32_t texel = bytesPerTexel(format);
    if (data.size() % texel != 0) {
        throw Error(formatText("texel buffer '{}': {} bytes are no whole number of {} texels", name,
                               data.size(), toString(format)));
    }
    auto storage =
        makeBuffer(impl_->context, name, BufferUse::Texel, data.empty() ? texel : data.size(), format);
    if (data.empty()) {
        impl_->transfer().zero(*storage);
    } else {
        impl_->transfer().upload(*storage, data);
    }
    return wrap(std::move(storage));
}

Buffer Device::createStorageBuffer(const std::string& name, uint64_t bytes) {
    auto storage = makeBuffer(impl_->context, name, BufferUse::Storage, bytes);
    impl_->transfer().zero(*storage);
    return wrap(std::move(storage));
}

Buffer Device::createStorageBuffer(const std::string& name, std::span<const std::byte> data) {
    auto storage = makeBuffer(impl_->context, name, BufferUse::Storage, data.size());
    impl_->transfer().upload(*storage, data);
    return wrap(std::move(storage));
}

std::vector<std::byte> Device::download(const Buffer& buffer) {
    if (!buffer) throw Error("an empty Buffer cannot be downloaded");
    const BufferStorage& storage = storageOf(*buffer.resource());
    if (storage.context != impl_->context)
        throw Error("buffer '" + storage.name + "' belongs to another device");
    waitIdle();
    std::vector<std::byte> data(storage.size);
    impl_->transfer().download(storage, data);
    return data;
}

void Device::waitIdle() {
    impl_->context->waitIdle();
}

std::vector<std::byte> Device::pipelineCacheData() const {
    return impl_->pipelines->data();
}

void Device::loadPipelineCache(std::span<const std::byte> data) {
    impl_->pipelines->load(data);
}

size_t Device::pipelineCount() const {
    return impl_->pipelines->made();
}

size_t Device::keptPipelineCount() const {
    return impl_->pipelines->kept();
}

void Device::onNewPipelines(std::function<void()> listener) {
    impl_->pipelines->onNewPipelines(std::move(listener));
}

FilterChoice filterChoice(const Device& device) {
    return {.backing = device.isCpu() ? Backing::Image : Backing::Buffer,
            .matrices = device.info().cooperativeMatrices,
            .largestBuffer = device.maxStorageBufferBytes(),
            .cpu = device.isCpu()};
}

}  // namespace limpid::gpu
