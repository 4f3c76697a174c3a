#include "gpu/vulkan/execute/frame_executor.h"

#include <algorithm>
#include <chrono>
#include <set>

#include "base/error.h"
#include "base/text/format.h"
#include "gpu/vulkan/check.h"
#include "gpu/vulkan/execute/acceleration_storage.h"

namespace limpid::gpu {
namespace {

/// Copies tightly packed rows that start at byte `offset` of `source`.
void copyToImage(const Context& context, VkCommandBuffer commands, VkBuffer source, uint64_t offset,
                 const Image& image) {
    VkBufferImageCopy region{};
    region.bufferOffset = offset;
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {image.extent.width, image.extent.height, 1};
    context.vk().CmdCopyBufferToImage(commands, source, image.image.get(), VK_IMAGE_LAYOUT_GENERAL, 1,
                                      &region);
}

constexpr VkAccessFlags2 storageAccess =
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;

VkImageMemoryBarrier2 wholeImageBarrier(VkImage image) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = wholeImage();
    return barrier;
}

VkImageMemoryBarrier2 foreignBarrier(const RecordedImage& recorded) {
    VkImageMemoryBarrier2 barrier = wholeImageBarrier(reinterpret_cast<VkImage>(recorded.foreign.image));
    barrier.subresourceRange.aspectMask = recorded.foreign.aspects;
    return barrier;
}

VkImageLayout layoutDuring(const RecordedImage& recorded) {
    return recorded.sampled ? static_cast<VkImageLayout>(recorded.foreign.layoutBefore)
                            : VK_IMAGE_LAYOUT_GENERAL;
}

const AccelerationStorage& structuresOf(const BoundResource& resource) {
    return static_cast<const AccelerationStorage&>(*resource.structures);
}

/// Borrowed uploads are pictures of frames that come one by one: waiting for copies costs hardly any time
/// then, and a staging buffer for all of them would take as much host memory as they do.
constexpr uint64_t stagingBytes = uint64_t{64} << 20;

/// How many uploads are staged together.
size_t uploadsTogether(std::span<const RecordedUpload> uploads) {
    const auto isBorrowed = [](const RecordedUpload& upload) { return upload.borrowed != nullptr; };
    if (std::none_of(uploads.begin(), uploads.end(), isBorrowed)) return uploads.size();
    size_t count = 1;
    while (count < uploads.size() &&
           uploads[count].at + uploads[count].size - uploads.front().at <= stagingBytes)
        ++count;
    return count;
}

/// Splits the uploads of a frame into those that are staged together.
std::vector<std::span<const RecordedUpload>> uploadGroups(std::span<const RecordedUpload> uploads,
                                                          bool foreign) {
    std::vector<std::span<const RecordedUpload>> groups;
    while (!uploads.empty()) {
        groups.push_back(uploads.first(foreign ? uploads.size() : uploadsTogether(uploads)));
        uploads = uploads.subspan(groups.back().size());
    }
    return groups;
}

}  // namespace

FrameExecutor::FrameExecutor(std::shared_ptr<const Context> context, std::shared_ptr<PipelineCache> pipelines,
                             const GraphOptions& options)
    : context_(std::move(context)),
      images_(context_, options.framesInFlight),
      pipelines_(std::move(pipelines)),
      prefix_(options.prefix) {
    for (uint32_t i = 0; i < options.framesInFlight; ++i) slots_.emplace_back(context_, i, options);
}

FrameExecutor::~FrameExecutor() {
    if (context_->submits()) context_->waitIdleNoThrow();
}

void FrameExecutor::execute(const RecordedFrame& frame) {
    constexpr Scope anything{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                             VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
    FrameSlot& slot = nextSlot();
    slot.begin(frame);
    recordFrame(frame, slot, anything);
    // Downloads are read by copies or through mapped memory.
    memoryBarrier(*context_, slot.commands(), VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                  VK_ACCESS_2_MEMORY_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
                  VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_HOST_READ_BIT);
    slot.submit(frame);
    finish(frame);
}

void FrameExecutor::record(const RecordedFrame& frame, VkCommandBuffer commands) {
    for (size_t i = 0; i < frame.passes.size(); ++i) {
        if (frame.dispatches[i].host)
            throw Error(
                formatText("pass '{}' runs on the host: it cannot be recorded", frame.passes[i].name));
    }
    constexpr Scope ours{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                         VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT,
                         VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT |
                             VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT};
    FrameSlot& slot = nextSlot();
    foreign_ = true;
    if (std::vector<PassTime> times = slot.beginForeign(frame, commands); !times.empty())
        foreignTimes_ = std::move(times);
    recordFrame(frame, slot, ours);
    releaseForeign(frame, commands);
    slot.endForeign(frame);
    finish(frame);
}

void FrameExecutor::recordFrame(const RecordedFrame& frame, FrameSlot& slot, const Scope& scope) {
    images_.collect(submitted_);
    acquireImages(frame);
    bindPasses(frame, slot);
    for (const std::span<const RecordedUpload> group : uploadGroups(frame.uploads, foreign_))
        slot.reserveStaging(group.back().at + group.back().size - group.front().at);
    prepareImages(frame, slot.commands(), scope);
    clearHistories(frame, slot.commands());
    recordUploads(frame, slot);
    slot.writeTimestamp(0);
    for (size_t i = 0; i < frame.passes.size(); ++i) {
        recordPass(frame, i, slot);
        slot.writeTimestamp(static_cast<uint32_t>(i) + 1);
    }
}

void FrameExecutor::finish(const RecordedFrame& frame) {
    for (size_t i = 0; i < frameImages_.size(); ++i) {
        ImagePool::Entry* const entry = frameImages_[i].pooled;
        if (!entry) continue;
        entry->initialised = true;
        entry->lastFrame = submitted_;
        if (frame.images[i].clear && !frame.images[i].written) entry->zero = true;
        if (frame.images[i].sharesWith) entry->zero = false;
    }
    ++submitted_;
}

/// Creates the images that are missing. If memory runs out, what earlier frames have left, such as images of
/// another size, may be in the way: frees those that no unfinished frame uses, and tries once more.
void FrameExecutor::acquireImages(const RecordedFrame& frame) {
    try {
        return lookUpImages(frame);
    } catch (const OutOfMemory&) {
        uint64_t finished = submitted_;
        if (context_->submits())
            context_->waitIdle();
        else  // the caller has waited for the frame whose slot is used again, and those before
            finished -= std::min<uint64_t>(submitted_, slots_.size() - 1);
        std::set<ImageKey> needed;
        for (const RecordedImage& recorded : frame.images) needed.insert(recorded.key);
        if (!images_.release(needed, finished)) throw;
    }
    lookUpImages(frame);
}

void FrameExecutor::lookUpImages(const RecordedFrame& frame) {
    frameImages_.clear();
    for (const RecordedImage& recorded : frame.images) {
        if (recorded.sharesWith) {
            frameImages_.push_back(frameImages_[*recorded.sharesWith]);
        } else if (recorded.role == RecordedImage::Role::Foreign) {
            frameImages_.push_back({nullptr, reinterpret_cast<VkImageView>(recorded.foreign.view),
                                    layoutDuring(recorded), nullptr});
        } else {
            ImagePool::Entry& entry = images_.acquire(recorded.key, prefix_);
            frameImages_.push_back(
                {&entry, entry.image.view.get(), VK_IMAGE_LAYOUT_GENERAL, entry.image.buffer.get()});
        }
    }
}

/// Gets the pipelines and descriptor sets of all passes. This may fail, and so comes before the first
/// command: half a frame in the caller's command buffer would spoil the histories.
void FrameExecutor::bindPasses(const RecordedFrame& frame, FrameSlot& slot) {
    bound_.assign(frame.passes.size(), {});
    for (size_t i = 0; i < frame.passes.size(); ++i) {
        const RecordedDispatch& dispatch = frame.dispatches[i];
        if (!dispatch.shader) continue;
        checkGroups(frame, i);
        bound_[i].pipeline = pipelines_->get(dispatch);
        slot.keep(bound_[i].pipeline.made);
        bound_[i].set = writeDescriptors(frame, i, bound_[i].pipeline.setLayout, slot);
    }
}

/// One barrier orders this frame after earlier work, and moves new images and written foreign images to
/// GENERAL layout.
void FrameExecutor::prepareImages(const RecordedFrame& frame, VkCommandBuffer commands, const Scope& scope) {
    std::vector<VkImageMemoryBarrier2> barriers;
    for (size_t i = 0; i < frame.images.size(); ++i) {
        const RecordedImage& recorded = frame.images[i];
        if (recorded.sharesWith) continue;
        if (recorded.role == RecordedImage::Role::Foreign) {
            if (!recorded.sampled && !recorded.stored) continue;  // no pass uses it
            VkImageMemoryBarrier2& barrier = barriers.emplace_back(foreignBarrier(recorded));
            barrier.srcStageMask = recorded.foreign.stagesBefore;
            barrier.srcAccessMask = recorded.foreign.accessBefore;
            barrier.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
            barrier.dstAccessMask = recorded.sampled ? VK_ACCESS_2_SHADER_SAMPLED_READ_BIT : storageAccess;
            barrier.oldLayout = static_cast<VkImageLayout>(recorded.foreign.layoutBefore);
            barrier.newLayout = frameImages_[i].layout;
            continue;
        }
        const ImagePool::Entry& entry = *frameImages_[i].pooled;
        if (entry.initialised || entry.image.buffer) continue;
        VkImageMemoryBarrier2& barrier = barriers.emplace_back(wholeImageBarrier(entry.image.image.get()));
        barrier.dstStageMask = scope.stages;
        barrier.dstAccessMask = scope.all;
        barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
        barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    }
    VkMemoryBarrier2 before{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    before.srcStageMask = scope.stages;
    before.srcAccessMask = scope.writes;
    before.dstStageMask = scope.stages;
    before.dstAccessMask = scope.all;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &before;
    dependency.imageMemoryBarrierCount = static_cast<uint32_t>(barriers.size());
    dependency.pImageMemoryBarriers = barriers.data();
    context_->vk().CmdPipelineBarrier2(commands, &dependency);
}

/// Returns written foreign images to the caller.
void FrameExecutor::releaseForeign(const RecordedFrame& frame, VkCommandBuffer commands) const {
    std::vector<VkImageMemoryBarrier2> barriers;
    for (const RecordedImage& recorded : frame.images) {
        if (recorded.role != RecordedImage::Role::Foreign || !recorded.stored) continue;
        VkImageMemoryBarrier2& barrier = barriers.emplace_back(foreignBarrier(recorded));
        barrier.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
        barrier.srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
        barrier.dstStageMask = recorded.foreign.stagesAfter;
        barrier.dstAccessMask = recorded.foreign.accessAfter;
        barrier.oldLayout = VK_IMAGE_LAYOUT_GENERAL;
        barrier.newLayout = static_cast<VkImageLayout>(recorded.foreign.layoutAfter);
    }
    if (barriers.empty()) return;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = static_cast<uint32_t>(barriers.size());
    dependency.pImageMemoryBarriers = barriers.data();
    context_->vk().CmdPipelineBarrier2(commands, &dependency);
}

/// Shaders may read an invalid history's previous image before they check the flag, so clear it to zero. What
/// is zero already, as after a warm-up, stays as it is.
void FrameExecutor::clearHistories(const RecordedFrame& frame, VkCommandBuffer commands) {
    bool any = false;
    for (size_t i = 0; i < frame.images.size(); ++i) {
        ImagePool::Entry* const entry = frameImages_[i].pooled;
        if (!entry) continue;
        if (frame.images[i].clear && !frame.images[i].sharesWith && !entry->zero) {
            clearImage(entry->image, commands);
            any = true;
        }
        if (frame.images[i].written) entry->zero = false;
    }
    if (!any) return;
    memoryBarrier(*context_, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                  VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
}

void FrameExecutor::clearImage(const Image& image, VkCommandBuffer commands) {
    ++cleared_;
    const VkClearColorValue zero{};
    const VkImageSubresourceRange range = wholeImage();
    if (image.buffer)
        context_->vk().CmdFillBuffer(commands, image.buffer->buffer.get(), 0, VK_WHOLE_SIZE, 0);
    else
        context_->vk().CmdClearColorImage(commands, image.image.get(), VK_IMAGE_LAYOUT_GENERAL, &zero, 1,
                                          &range);
}

void FrameExecutor::clear(const RecordedFrame& frame, VkCommandBuffer commands) {
    // All are created before one counts as cleared, since memory may run out in between.
    std::vector<ImagePool::Entry*> entries, fresh;
    for (const RecordedImage& recorded : frame.images)
        if (recorded.role != RecordedImage::Role::Foreign)
            entries.push_back(&images_.acquire(recorded.key, prefix_));
    std::vector<VkImageMemoryBarrier2> barriers;
    for (ImagePool::Entry* const entry : entries) {
        if (entry->initialised) continue;
        entry->initialised = true;
        entry->lastFrame = submitted_;  // the commands run before the next frame
        entry->zero = true;
        fresh.push_back(entry);
        if (entry->image.buffer) continue;
        VkImageMemoryBarrier2& barrier = barriers.emplace_back(wholeImageBarrier(entry->image.image.get()));
        barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
        barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
        barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    }
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = static_cast<uint32_t>(barriers.size());
    dependency.pImageMemoryBarriers = barriers.data();
    if (!barriers.empty()) context_->vk().CmdPipelineBarrier2(commands, &dependency);
    for (const ImagePool::Entry* entry : fresh) clearImage(entry->image, commands);
}

void FrameExecutor::recordUploads(const RecordedFrame& frame, FrameSlot& slot) {
    if (frame.uploads.empty()) return;
    const auto groups = uploadGroups(frame.uploads, foreign_);
    for (size_t i = 0; i < groups.size(); ++i) {
        if (i > 0) slot.flush();  // the staging buffer is used again
        recordCopies(frame, groups[i], slot);
    }
    memoryBarrier(*context_, slot.commands(), VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                  VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                  VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
}

void FrameExecutor::recordCopies(const RecordedFrame& frame, std::span<const RecordedUpload> uploads,
                                 FrameSlot& slot) {
    const VkBuffer staging = slot.stage(uploads, frame.uploadData);
    for (const RecordedUpload& upload : uploads) {
        const uint64_t from = upload.at - uploads.front().at;
        const Image* image = upload.buffer ? nullptr : &frameImages_[upload.image].pooled->image;
        if (image && !image->buffer) {
            copyToImage(*context_, slot.commands(), staging, from, *image);
            continue;
        }
        const BufferStorage& buffer = image ? *image->buffer : storageOf(*upload.buffer);
        const VkBufferCopy region{from, upload.offset, upload.size};
        context_->vk().CmdCopyBuffer(slot.commands(), staging, buffer.buffer.get(), 1, &region);
    }
}

void FrameExecutor::checkGroups(const RecordedFrame& frame, size_t index) const {
    if (frame.dispatches[index].shader->tracesRays()) {
        const auto& groups = frame.dispatches[index].groups;
        const uint64_t rays = uint64_t{groups[0]} * groups[1];
        if (rays <= context_->rayTracing().maxInvocations) return;
        throw Error(formatText("pass '{}' starts {} rays, more than maxRayDispatchInvocationCount = {} of {}",
                               frame.passes[index].name, rays, context_->rayTracing().maxInvocations,
                               context_->info().name));
    }
    for (size_t axis = 0; axis < 3; ++axis) {
        const uint32_t asked = frame.dispatches[index].groups[axis];
        const uint32_t maximum = context_->limits().maxComputeWorkGroupCount[axis];
        if (asked > maximum) {
            throw Error(
                formatText("pass '{}' dispatches {} workgroups along axis {}, more than "
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
    if (!pass.hazards.empty()) passBarrier(*context_, commands);
    if (dispatch.shader) return recordDispatch(frame, index, slot);
    beginLabel(commands, pass.name);
    structuresOf(dispatch.resources.front()).recordRebuild(commands);
    endLabel(commands);
}

void FrameExecutor::runOnHost(const RecordedFrame& frame, size_t index, FrameSlot& slot) {
    std::vector<std::span<std::byte>> pixels;
    for (const uint32_t image : frame.dispatches[index].hostImages) {
        const RecordedImage& recorded = frame.images[image];
        std::byte* const mapped = frameImages_[image].buffer->memory.mapped;
        if (!mapped)
            throw Error(formatText("pass '{}': the host cannot see image '{}' in the memory of {}",
                                   frame.passes[index].name, recorded.name, context_->info().name));
        pixels.emplace_back(mapped, recorded.bytes());
    }
    memoryBarrier(*context_, slot.commands(), VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                  VK_ACCESS_2_MEMORY_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT,
                  VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_HOST_WRITE_BIT);
    if (slices_)
        submitSlice(slot);
    else
        slot.flush();
    frame.dispatches[index].host(pixels);  // its writes are visible to everything submitted afterwards
    if (slices_ && slices_->interrupted()) throw Interrupted();
}

void FrameExecutor::recordDispatch(const RecordedFrame& frame, size_t index, FrameSlot& slot) {
    const VkCommandBuffer commands = slot.commands();
    const auto& [pipeline, set] = bound_[index];
    if (slices_ && !pipeline.table()) return recordSlices(frame, index, pipeline, set, slot);
    beginLabel(commands, frame.passes[index].name);
    bind(commands, pipeline, set);
    const auto& groups = frame.dispatches[index].groups;
    if (const ShaderTable* const table = pipeline.table()) {
        const VkStridedDeviceAddressRegionKHR callable{};
        context_->vk().CmdTraceRaysKHR(commands, &table->rayGeneration, &table->miss, &table->hit, &callable,
                                       groups[0], groups[1], groups[2]);
    } else {
        context_->vk().CmdDispatch(commands, groups[0], groups[1], groups[2]);
    }
    endLabel(commands);
}

void FrameExecutor::bind(VkCommandBuffer commands, const PipelineCache::Pipeline& pipeline,
                         VkDescriptorSet set) const {
    const VkPipelineBindPoint point =
        pipeline.table() ? VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR : VK_PIPELINE_BIND_POINT_COMPUTE;
    context_->vk().CmdBindPipeline(commands, point, pipeline.handle());
    context_->vk().CmdBindDescriptorSets(commands, point, pipeline.layout, 0, 1, &set, 0, nullptr);
}

/// Short passes are submitted together; each slice of a long one alone, which also orders it after the one
/// before.
void FrameExecutor::recordSlices(const RecordedFrame& frame, size_t index,
                                 const PipelineCache::Pipeline& pipeline, VkDescriptorSet set,
                                 FrameSlot& slot) {
    const std::string& pass = frame.passes[index].name;
    const auto& groups = frame.dispatches[index].groups;
    const uint64_t groupsPerRow = uint64_t{groups[0]} * groups[2];
    for (uint32_t row = 0; row < groups[1];) {
        const uint32_t rows = slices_->rows(pass, groupsPerRow, groups[1] - row);
        const double expected = slices_->seconds(pass, groupsPerRow * rows);
        const bool alone = expected == 0.0 || rows < groups[1];
        if (slices_->pending > 0.0 && (alone || slices_->pending + expected > TimeSlices::sliceSeconds))
            submitSlice(slot);
        const VkCommandBuffer commands = slot.commands();
        beginLabel(commands, pass);
        bind(commands, pipeline, set);
        context_->vk().CmdDispatchBase(commands, 0, row, 0, groups[0], rows, groups[2]);
        endLabel(commands);
        slices_->pending += expected;
        if (alone) slices_->note(pass, groupsPerRow * rows, submitSlice(slot));
        row += rows;
    }
}

/// Submits what was recorded, and waits. Returns the seconds that it took. Throws Interrupted.
double FrameExecutor::submitSlice(FrameSlot& slot) {
    const auto begin = std::chrono::steady_clock::now();
    slot.flush();
    slices_->pending = 0.0;
    if (slices_->interrupted()) throw Interrupted();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void FrameExecutor::setInterruption(std::function<bool()> interrupted) {
    if (!interrupted)
        slices_.reset();
    else if (!slices_)
        slices_.emplace(std::move(interrupted));
    else
        slices_->interrupted = std::move(interrupted);
}

VkDescriptorSet FrameExecutor::writeDescriptors(const RecordedFrame& frame, size_t index,
                                                VkDescriptorSetLayout layout, FrameSlot& slot) {
    const RecordedDispatch& dispatch = frame.dispatches[index];
    const VkDescriptorSet set = slot.allocateSet(layout);
    std::vector<VkWriteDescriptorSet> writes;
    std::vector<VkDescriptorImageInfo> images;
    std::vector<VkDescriptorBufferInfo> buffers;
    std::vector<VkBufferView> views;
    std::vector<VkWriteDescriptorSetAccelerationStructureKHR> structures;
    const size_t count = dispatch.resources.size() + 1;  // the writes point into these four vectors, so they
                                                         // must not reallocate
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
        if (resource.kind == BindingKind::StorageImage || resource.kind == BindingKind::SampledImage) {
            const FrameImage& image = frameImages_[resource.image];
            images.push_back({VK_NULL_HANDLE, image.view, image.layout});
            write.pImageInfo = &images.back();
        } else if (!resource.buffer) {
            const BufferStorage& buffer = *frameImages_[resource.image].buffer;
            buffers.push_back({buffer.buffer.get(), 0, buffer.allocated});
            write.pBufferInfo = &buffers.back();
        } else if (resource.kind == BindingKind::StorageTexelBuffer) {
            views.push_back(storageOf(*resource.buffer).view.get());
            write.pTexelBufferView = &views.back();
        } else if (resource.kind == BindingKind::AccelerationStructure) {
            VkWriteDescriptorSetAccelerationStructureKHR& info = structures.emplace_back();
            info.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR;
            info.accelerationStructureCount = 1;
            info.pAccelerationStructures = &structuresOf(resource).topHandle;
            write.pNext = &info;
        } else {
            const BufferStorage& buffer = storageOf(*resource.buffer);
            buffers.push_back({buffer.buffer.get(), 0, buffer.allocated});
            write.pBufferInfo = &buffers.back();
        }
    }
    if (dispatch.paramsSize != 0) {
        const std::span<const std::byte> params(frame.params);
        buffers.push_back(slot.pushParams(params.subspan(dispatch.paramsOffset, dispatch.paramsSize)));
        add(dispatch.paramsBinding, BindingKind::UniformBuffer).pBufferInfo = &buffers.back();
    }
    context_->vk().UpdateDescriptorSets(context_->device(), static_cast<uint32_t>(writes.size()),
                                        writes.data(), 0, nullptr);
    return set;
}

void FrameExecutor::beginLabel(VkCommandBuffer commands, const std::string& name) const {
    if (!context_->hasDebugUtils()) return;
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    const std::string labelled = prefix_ + name;
    label.pLabelName = labelled.c_str();
    context_->vk().CmdBeginDebugUtilsLabelEXT(commands, &label);
}

void FrameExecutor::endLabel(VkCommandBuffer commands) const {
    if (context_->hasDebugUtils()) context_->vk().CmdEndDebugUtilsLabelEXT(commands);
}

const Image& FrameExecutor::image(const RecordedImage& recorded) const {
    const Image* image = images_.find(recorded.key);
    if (!image) throw Error(formatText("image '{}' is not on the device", recorded.name));
    return *image;
}

std::vector<PassTime> FrameExecutor::passTimes() {
    if (submitted_ == 0) return {};
    if (foreign_) return foreignTimes_;
    return slots_[(submitted_ - 1) % slots_.size()].passTimes();
}

}  // namespace limpid::gpu
