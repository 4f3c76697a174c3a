#include "gpu/vulkan/execute/frame_executor.h"

#include <fmt/format.h>

#include "base/error.h"
#include "gpu/vulkan/check.h"

namespace limpid::gpu {
namespace {

/// Tightly packed rows, from byte `offset` of `source` on.
void copyToImage(VkCommandBuffer commands, VkBuffer source, uint64_t offset, const Image& image) {
    VkBufferImageCopy region{};
    region.bufferOffset = offset;
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {image.extent.width, image.extent.height, 1};
    vkCmdCopyBufferToImage(commands, source, image.image.get(), VK_IMAGE_LAYOUT_GENERAL, 1, &region);
}

}  // namespace

FrameExecutor::FrameExecutor(std::shared_ptr<const Context> context)
    : context_(std::move(context)),
      images_(context_),
      pipelines_(context_),
      slots_{FrameSlot(context_, 0), FrameSlot(context_, 1)} {}

FrameExecutor::~FrameExecutor() {
    context_->waitIdleNoThrow();
}

void FrameExecutor::execute(const RecordedFrame& frame) {
    FrameSlot& slot = slots_[submitted_ % slots_.size()];
    slot.begin(frame);
    images_.collect(submitted_);
    const VkCommandBuffer commands = slot.commands();
    prepareImages(frame, commands);
    clearHistories(frame, commands);
    recordUploads(frame, slot);
    slot.writeTimestamp(0);
    for (size_t i = 0; i < frame.passes.size(); ++i) {
        recordPass(frame, i, slot);
        slot.writeTimestamp(static_cast<uint32_t>(i) + 1);
    }
    // Downloads read by copies, or through mapped memory.
    memoryBarrier(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
                  VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_HOST_READ_BIT);
    slot.submit(frame);
    ++submitted_;
    for (ImagePool::Entry* entry : frameImages_) entry->initialised = true;
}

/// One barrier orders this frame behind all earlier work and brings fresh images into GENERAL layout.
void FrameExecutor::prepareImages(const RecordedFrame& frame, VkCommandBuffer commands) {
    frameImages_.clear();
    std::vector<VkImageMemoryBarrier2> fresh;
    for (const RecordedImage& recorded : frame.images) {
        ImagePool::Entry& entry = images_.acquire(recorded.key, submitted_);
        frameImages_.push_back(&entry);
        if (entry.initialised || entry.image.buffer) continue;
        VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
        barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
        barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
        barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
        barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = entry.image.image.get();
        barrier.subresourceRange = wholeImage();
        fresh.push_back(barrier);
    }
    VkMemoryBarrier2 before{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    before.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    before.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    before.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    before.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &before;
    dependency.imageMemoryBarrierCount = static_cast<uint32_t>(fresh.size());
    dependency.pImageMemoryBarriers = fresh.data();
    vkCmdPipelineBarrier2(commands, &dependency);
}

/// Shaders may read an invalid history's previous image before they look at the flag: it is zero, never
/// garbage.
void FrameExecutor::clearHistories(const RecordedFrame& frame, VkCommandBuffer commands) {
    bool any = false;
    const VkClearColorValue zero{};
    const VkImageSubresourceRange range = wholeImage();
    for (size_t i = 0; i < frame.images.size(); ++i) {
        if (!frame.images[i].clear) continue;
        const Image& image = frameImages_[i]->image;
        if (image.buffer)
            vkCmdFillBuffer(commands, image.buffer->buffer.get(), 0, VK_WHOLE_SIZE, 0);
        else
            vkCmdClearColorImage(commands, image.image.get(), VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &range);
        any = true;
    }
    if (!any) return;
    memoryBarrier(commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                  VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
}

void FrameExecutor::recordUploads(const RecordedFrame& frame, FrameSlot& slot) {
    if (frame.uploads.empty()) return;
    const VkBuffer staging = slot.stage(frame.uploadData);
    for (const RecordedUpload& upload : frame.uploads) {
        const Image* image = upload.buffer ? nullptr : &frameImages_[upload.image]->image;
        if (image && !image->buffer) {
            copyToImage(slot.commands(), staging, upload.at, *image);
            continue;
        }
        const BufferStorage& buffer = image ? *image->buffer : *upload.buffer;
        const VkBufferCopy region{upload.at, upload.offset, upload.size};
        vkCmdCopyBuffer(slot.commands(), staging, buffer.buffer.get(), 1, &region);
    }
    memoryBarrier(slot.commands(), VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                  VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
}

void FrameExecutor::checkGroups(const RecordedFrame& frame, size_t index) const {
    if (frame.dispatches[index].shader->tracesRays()) {
        const auto& groups = frame.dispatches[index].groups;
        const uint64_t rays = uint64_t{groups[0]} * groups[1];
        if (rays <= context_->rayTracing().maxInvocations) return;
        throw Error(fmt::format(
            "pass '{}' starts {} rays, more than maxRayDispatchInvocationCount = {} of {}",
            frame.passes[index].name, rays, context_->rayTracing().maxInvocations, context_->info().name));
    }
    for (size_t axis = 0; axis < 3; ++axis) {
        const uint32_t asked = frame.dispatches[index].groups[axis];
        const uint32_t maximum = context_->limits().maxComputeWorkGroupCount[axis];
        if (asked > maximum) {
            throw Error(
                fmt::format("pass '{}' dispatches {} workgroups along axis {}, more than "
                            "maxComputeWorkGroupCount = {} of {}",
                            frame.passes[index].name, asked, axis, maximum, context_->info().name));
        }
    }
}

void FrameExecutor::recordPass(const RecordedFrame& frame, size_t index, FrameSlot& slot) {
    const RecordedPass& pass = frame.passes[index];
    const RecordedDispatch& dispatch = frame.dispatches[index];
    if (dispatch.host) return runOnHost(frame, index, slot);
    const VkCommandBuffer commands = slot.commands();
    beginLabel(commands, pass.name);
    if (!pass.hazards.empty()) passBarrier(*context_, commands);
    if (dispatch.shader) {
        recordDispatch(frame, index, slot);
    } else {
        dispatch.resources.front().structures->recordRebuild(commands);
    }
    endLabel(commands);
}

void FrameExecutor::runOnHost(const RecordedFrame& frame, size_t index, FrameSlot& slot) {
    std::vector<std::span<std::byte>> pixels;
    for (const uint32_t image : frame.dispatches[index].hostImages) {
        const RecordedImage& recorded = frame.images[image];
        std::byte* const mapped = frameImages_[image]->image.buffer->memory.mapped;
        if (!mapped)
            throw Error(fmt::format("pass '{}': the host cannot see image '{}' in the memory of {}",
                                    frame.passes[index].name, recorded.name, context_->info().name));
        pixels.emplace_back(mapped, recorded.bytes());
    }
    memoryBarrier(slot.commands(), VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_HOST_WRITE_BIT);
    slot.flush();
    frame.dispatches[index].host(pixels);  // what it writes is seen by all that is submitted after it
}

void FrameExecutor::recordDispatch(const RecordedFrame& frame, size_t index, FrameSlot& slot) {
    checkGroups(frame, index);
    const RecordedDispatch& dispatch = frame.dispatches[index];
    const VkCommandBuffer commands = slot.commands();
    const PipelineCache::Pipeline pipeline = pipelines_.get(dispatch);
    const VkDescriptorSet set = writeDescriptors(frame, index, pipeline.setLayout, slot);
    const ShaderTable* table = pipeline.table;
    const VkPipelineBindPoint point =
        table ? VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR : VK_PIPELINE_BIND_POINT_COMPUTE;
    vkCmdBindPipeline(commands, point, pipeline.pipeline);
    vkCmdBindDescriptorSets(commands, point, pipeline.layout, 0, 1, &set, 0, nullptr);
    const auto& groups = dispatch.groups;
    if (table) {
        const VkStridedDeviceAddressRegionKHR callable{};
        vkCmdTraceRaysKHR(commands, &table->rayGeneration, &table->miss, &table->hit, &callable, groups[0],
                          groups[1], groups[2]);
    } else {
        vkCmdDispatch(commands, groups[0], groups[1], groups[2]);
    }
}

VkDescriptorSet FrameExecutor::writeDescriptors(const RecordedFrame& frame, size_t index,
                                                VkDescriptorSetLayout layout, FrameSlot& slot) {
    const RecordedDispatch& dispatch = frame.dispatches[index];
    const VkDescriptorSet set = slot.allocateSet(layout, frame.passes[index].name);
    std::vector<VkWriteDescriptorSet> writes;
    std::vector<VkDescriptorImageInfo> images;
    std::vector<VkDescriptorBufferInfo> buffers;
    std::vector<VkBufferView> views;
    std::vector<VkWriteDescriptorSetAccelerationStructureKHR> structures;
    const size_t count = dispatch.resources.size() + 1;  // the writes point into the four: they must not grow
    images.reserve(count);
    buffers.reserve(count);
    views.reserve(count);
    structures.reserve(count);
    const auto add = [&](uint32_t binding, BindingKind kind) -> VkWriteDescriptorSet& {
        VkWriteDescriptorSet& write = writes.emplace_back();
        write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        write.dstSet = set;
        write.dstBinding = binding;
        write.descriptorCount = 1;
        write.descriptorType = descriptorType(kind);
        return write;
    };
    for (const BoundResource& resource : dispatch.resources) {
        VkWriteDescriptorSet& write = add(resource.binding, resource.kind);
        if (resource.kind == BindingKind::StorageImage) {
            const Image& image = frameImages_[resource.image]->image;
            images.push_back({VK_NULL_HANDLE, image.view.get(), VK_IMAGE_LAYOUT_GENERAL});
            write.pImageInfo = &images.back();
        } else if (!resource.buffer) {
            const BufferStorage& buffer = *frameImages_[resource.image]->image.buffer;
            buffers.push_back({buffer.buffer.get(), 0, buffer.allocated});
            write.pBufferInfo = &buffers.back();
        } else if (resource.kind == BindingKind::StorageTexelBuffer) {
            views.push_back(resource.buffer->view.get());
            write.pTexelBufferView = &views.back();
        } else if (resource.kind == BindingKind::AccelerationStructure) {
            VkWriteDescriptorSetAccelerationStructureKHR& info = structures.emplace_back();
            info.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR;
            info.accelerationStructureCount = 1;
            info.pAccelerationStructures = &resource.structures->topHandle;
            write.pNext = &info;
        } else {
            buffers.push_back({resource.buffer->buffer.get(), 0, resource.buffer->allocated});
            write.pBufferInfo = &buffers.back();
        }
    }
    if (dispatch.paramsSize != 0) {
        const std::span<const std::byte> params(frame.params);
        buffers.push_back(slot.pushParams(params.subspan(dispatch.paramsOffset, dispatch.paramsSize)));
        add(dispatch.paramsBinding, BindingKind::UniformBuffer).pBufferInfo = &buffers.back();
    }
    vkUpdateDescriptorSets(context_->device(), static_cast<uint32_t>(writes.size()), writes.data(), 0,
                           nullptr);
    return set;
}

void FrameExecutor::beginLabel(VkCommandBuffer commands, const std::string& name) const {
    if (!context_->hasDebugUtils()) return;
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    label.pLabelName = name.c_str();
    vkCmdBeginDebugUtilsLabelEXT(commands, &label);
}

void FrameExecutor::endLabel(VkCommandBuffer commands) const {
    if (context_->hasDebugUtils()) vkCmdEndDebugUtilsLabelEXT(commands);
}

const Image& FrameExecutor::image(const RecordedImage& recorded) const {
    const Image* image = images_.find(recorded.key);
    if (!image) throw Error(fmt::format("image '{}' is not on the device", recorded.name));
    return *image;
}

std::vector<PassTime> FrameExecutor::passTimes() {
    if (submitted_ == 0) return {};
    return slots_[(submitted_ - 1) % slots_.size()].passTimes();
}

}  // namespace limpid::gpu
