#include "gpu/vulkan/execute/frame_slot.h"

#include <algorithm>
#include <cstring>

#include "base/text/format.h"
#include "gpu/vulkan/check.h"
#include "gpu/vulkan/execute/pipeline_cache.h"

namespace limpid::gpu {

FrameSlot::FrameSlot(std::shared_ptr<const Context> context, uint32_t index, const GraphOptions& options)
    : context_(std::move(context)),
      index_(index),
      prefix_(options.prefix),
      timed_(options.timestamps && context_->timestampValidBits() != 0) {}

std::string FrameSlot::name(const char* what) const {
    return formatText("{}frame slot {} {}", prefix_, index_, what);
}

void FrameSlot::makeCommands() {
    if (commandPool_) return;
    commandPool_ = makeCommandPool(*context_, name("commands"));
    ownCommands_ = allocateCommandBuffer(*context_, commandPool_.get(), name("commands"));
    fence_ = makeFence(*context_, name("fence"));
}

void FrameSlot::wait() {
    if (!submitted_) return;
    const VkFence fence = fence_.get();
    LIMPID_VK(context_->vk().WaitForFences(context_->device(), 1, &fence, VK_TRUE, UINT64_MAX));
}

void FrameSlot::makeRoom(const RecordedFrame& frame) {
    buffers_.clear();
    structures_.clear();
    used_.clear();
    passNames_.clear();
    reserveDescriptors(frame);
    reserveParams(frame);
    if (timed_) reserveTimestamps(static_cast<uint32_t>(frame.passes.size()) + 1);
}

void FrameSlot::begin(const RecordedFrame& frame) {
    makeCommands();
    wait();
    const VkFence fence = fence_.get();
    if (std::exchange(submitted_, false))
        LIMPID_VK(context_->vk().ResetFences(context_->device(), 1, &fence));
    makeRoom(frame);
    LIMPID_VK(context_->vk().ResetCommandPool(context_->device(), commandPool_.get(), 0));
    commands_ = ownCommands_;
    beginCommands(*context_, commands_);
    if (timed_) context_->vk().CmdResetQueryPool(commands_, timestamps_.get(), 0, timestampCapacity_);
}

std::vector<PassTime> FrameSlot::beginForeign(const RecordedFrame& frame, VkCommandBuffer commands) {
    std::vector<PassTime> times = passTimes();
    makeRoom(frame);
    commands_ = commands;
    if (timed_) context_->vk().CmdResetQueryPool(commands_, timestamps_.get(), 0, timestampCapacity_);
    return times;
}

void FrameSlot::endForeign(const RecordedFrame& frame) {
    keep(frame);
}

/// Keeps the frame's resources alive until the slot's next frame begins.
void FrameSlot::keep(const RecordedFrame& frame) {
    for (const RecordedDispatch& dispatch : frame.dispatches) {
        for (const BoundResource& resource : dispatch.resources) {
            if (resource.buffer) buffers_.push_back(resource.buffer);
            if (resource.structures) structures_.push_back(resource.structures);
        }
    }
    for (const RecordedUpload& upload : frame.uploads) {
        if (upload.buffer) buffers_.push_back(upload.buffer);
    }
    for (const RecordedPass& pass : frame.passes) passNames_.push_back(pass.name);
}

void FrameSlot::submit(const RecordedFrame& frame) {
    LIMPID_VK(context_->vk().EndCommandBuffer(commands_));
    keep(frame);
    context_->submit(commands_, fence_.get());
    submitted_ = true;
}

void FrameSlot::flush() {
    LIMPID_VK(context_->vk().EndCommandBuffer(commands_));
    context_->submit(commands_, fence_.get());
    submitted_ = true;
    wait();
    const VkFence fence = fence_.get();
    LIMPID_VK(context_->vk().ResetFences(context_->device(), 1, &fence));
    submitted_ = false;
    LIMPID_VK(context_->vk().ResetCommandPool(context_->device(), commandPool_.get(), 0));
    beginCommands(*context_, commands_);
}

/// Resets the pool, or replaces it with one twice as large as the frame needs.
void FrameSlot::reserveDescriptors(const RecordedFrame& frame) {
    std::array<uint32_t, bindingKindCount> needed{};
    const uint32_t sets = static_cast<uint32_t>(frame.dispatches.size());
    for (const RecordedDispatch& dispatch : frame.dispatches) {
        if (!dispatch.shader) continue;
        for (const ShaderBinding& binding : dispatch.shader->reflection.bindings) {
            ++needed[static_cast<size_t>(binding.kind)];
        }
    }
    bool fits = descriptors_ && sets <= setCapacity_;
    for (size_t i = 0; i < needed.size(); ++i) fits = fits && needed[i] <= descriptorCapacity_[i];
    if (fits) {
        LIMPID_VK(context_->vk().ResetDescriptorPool(context_->device(), descriptors_.get(), 0));
        return;
    }
    std::array<uint32_t, bindingKindCount> capacity{};
    std::vector<VkDescriptorPoolSize> sizes;
    for (size_t i = 0; i < needed.size(); ++i) {
        const auto kind = static_cast<BindingKind>(i);
        if (kind == BindingKind::AccelerationStructure && !context_->hasRayTracing()) continue;
        capacity[i] = std::max(16u, 2 * needed[i]);
        sizes.push_back({descriptorType(kind), capacity[i]});
    }
    VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.maxSets = std::max(16u, 2 * sets);
    info.poolSizeCount = static_cast<uint32_t>(sizes.size());
    info.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    LIMPID_VK(context_->vk().CreateDescriptorPool(context_->device(), &info, nullptr, &pool));
    descriptors_ = UniqueDescriptorPool(context_->vk(), pool);
    descriptorCapacity_ = capacity;
    setCapacity_ = info.maxSets;
    context_->setName(pool, name("descriptors"));
}

uint64_t FrameSlot::alignedSize(uint64_t bytes) const {
    return alignUp(bytes, std::max<uint64_t>(16, context_->limits().minUniformBufferOffsetAlignment));
}

void FrameSlot::reserveParams(const RecordedFrame& frame) {
    uint64_t needed = 0;
    for (const RecordedDispatch& dispatch : frame.dispatches) needed += alignedSize(dispatch.paramsSize);
    if (needed != 0 && (!params_ || params_->size < needed)) {
        params_.reset();
        params_ = makeBuffer(context_, name("parameters"), BufferUse::Uniform,
                             std::max<uint64_t>(64 << 10, 2 * needed));
    }
    paramsUsed_ = 0;
}

VkDescriptorBufferInfo FrameSlot::pushParams(std::span<const std::byte> params) {
    const uint64_t offset = paramsUsed_;
    std::memcpy(params_->memory.mapped + offset, params.data(), params.size());
    paramsUsed_ += alignedSize(params.size());
    return {params_->buffer.get(), offset, params.size()};
}

void FrameSlot::reserveStaging(uint64_t bytes) {
    if (staging_ && staging_->size >= bytes) return;
    staging_.reset();
    // Small uploads vary from frame to frame, so leave room; pictures do not vary and are too large for that.
    staging_ = makeBuffer(context_, name("uploads"), BufferUse::Staging,
                          std::max<uint64_t>(64 << 10, bytes < (256u << 10) ? 2 * bytes : bytes));
}

VkBuffer FrameSlot::stage(std::span<const RecordedUpload> uploads, std::span<const std::byte> copies) {
    const uint64_t first = uploads.front().at;
    for (const RecordedUpload& upload : uploads)
        std::memcpy(staging_->memory.mapped + (upload.at - first),
                    upload.borrowed ? upload.borrowed : copies.data() + upload.copied, upload.size);
    return staging_->buffer.get();
}

void FrameSlot::reserveTimestamps(uint32_t count) {
    if (count <= timestampCapacity_) return;
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = std::max(64u, 2 * count);
    VkQueryPool pool = VK_NULL_HANDLE;
    LIMPID_VK(context_->vk().CreateQueryPool(context_->device(), &info, nullptr, &pool));
    timestamps_ = UniqueQueryPool(context_->vk(), pool);
    timestampCapacity_ = info.queryCount;
    context_->setName(pool, name("timestamps"));
}

VkDescriptorSet FrameSlot::allocateSet(VkDescriptorSetLayout layout) {
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    info.descriptorPool = descriptors_.get();
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    LIMPID_VK(context_->vk().AllocateDescriptorSets(context_->device(), &info, &set));
    // Without a name: the validation layer never forgets the names of sets whose pool is reset.
    return set;
}

void FrameSlot::writeTimestamp(uint32_t stamp) {
    if (!timed_) return;
    context_->vk().CmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, timestamps_.get(),
                                      stamp);
}

std::vector<PassTime> FrameSlot::passTimes() {
    wait();
    if (passNames_.empty() || !timed_) return {};
    std::vector<uint64_t> ticks(passNames_.size() + 1);
    // Times of a frame that the caller never submitted will never be available.
    const VkQueryResultFlags waits = submitted_ ? VK_QUERY_RESULT_WAIT_BIT : 0;
    const VkResult result = context_->vk().GetQueryPoolResults(
        context_->device(), timestamps_.get(), 0, static_cast<uint32_t>(ticks.size()),
        ticks.size() * sizeof(uint64_t), ticks.data(), sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | waits);
    if (result == VK_NOT_READY) return {};
    LIMPID_VK(result);
    const uint32_t bits = context_->timestampValidBits();
    const uint64_t mask = bits >= 64 ? UINT64_MAX : (uint64_t{1} << bits) - 1;
    std::vector<PassTime> times;
    for (size_t i = 0; i < passNames_.size(); ++i) {
        // The difference modulo the counter's width is correct across one wrap-around.
        const uint64_t elapsed = (ticks[i + 1] - ticks[i]) & mask;
        times.push_back(
            {passNames_[i], static_cast<double>(elapsed) * context_->limits().timestampPeriod * 1e-6});
    }
    return times;
}

}  // namespace limpid::gpu
