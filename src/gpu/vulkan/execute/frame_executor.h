// Runs recorded frames on a device, or records them into the caller's command buffer.
//
// Synchronisation by record(): Before the passes, one vkCmdPipelineBarrier2 contains
// - a memory barrier from compute shaders and copies (writes) to compute shaders and copies (reads and
//   writes), so that the graph's earlier frames on the same queue come first;
// - an image barrier for each imported image, from ForeignImage::stagesBefore and accessBefore to compute
//   shaders, and into GENERAL if it is bound as a storage image.
// After the passes, another one contains an image barrier for each imported image that a pass wrote, from
// compute shaders to stagesAfter and accessAfter, and into layoutAfter. Nothing else is synchronised: there
// are no queue-ownership transfers, events or semaphores.
#pragma once

#include <functional>
#include <optional>

#include "gpu/vulkan/device_impl.h"
#include "gpu/vulkan/execute/frame_slot.h"
#include "gpu/vulkan/execute/pipeline_cache.h"
#include "gpu/vulkan/execute/time_slices.h"
#include "gpu/vulkan/memory/image_pool.h"

namespace limpid::gpu {

class FrameExecutor {
  public:
    FrameExecutor(std::shared_ptr<const Context> context, std::shared_ptr<PipelineCache> pipelines,
                  const GraphOptions& options);
    ~FrameExecutor();

    const Context& context() const { return *context_; }
    void execute(const RecordedFrame& frame);
    /// After an exception `commands` contains nothing of effect.
    void record(const RecordedFrame& frame, VkCommandBuffer commands);
    /// See FrameGraph::setInterruption().
    void setInterruption(std::function<bool()> interrupted);
    /// Creates the frame's images that no frame has used yet, and records their clearing. Executes no pass.
    void clear(const RecordedFrame& frame, VkCommandBuffer commands);
    /// Returns the device image behind an image of an executed frame.
    const Image& image(const RecordedImage& recorded) const;
    std::vector<PassTime> passTimes();
    size_t pooledImages() const { return images_.size(); }
    /// The number of images whose clearing was recorded so far.
    size_t clearedImages() const { return cleared_; }

  private:
    /// The device side of a recorded image.
    struct FrameImage {
        ImagePool::Entry* pooled = nullptr;  ///< null for imported images
        VkImageView view = VK_NULL_HANDLE;
        VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL;  ///< while the frame runs
        const BufferStorage* buffer = nullptr;           ///< set with Backing::Buffer
    };
    /// What a pass is bound to; empty if it dispatches no shader.
    struct BoundPass {
        PipelineCache::Pipeline pipeline;
        VkDescriptorSet set = VK_NULL_HANDLE;
    };
    /// Accesses of earlier commands that the frame must wait for.
    struct Scope {
        VkPipelineStageFlags2 stages;
        VkAccessFlags2 writes, all;
    };
    FrameSlot& nextSlot() { return slots_[submitted_ % slots_.size()]; }
    void recordFrame(const RecordedFrame& frame, FrameSlot& slot, const Scope& scope);
    void releaseForeign(const RecordedFrame& frame, VkCommandBuffer commands) const;
    void finish(const RecordedFrame& frame);
    void acquireImages(const RecordedFrame& frame);
    void lookUpImages(const RecordedFrame& frame);
    void bindPasses(const RecordedFrame& frame, FrameSlot& slot);
    void prepareImages(const RecordedFrame& frame, VkCommandBuffer commands, const Scope& scope);
    void clearHistories(const RecordedFrame& frame, VkCommandBuffer commands);
    void clearImage(const Image& image, VkCommandBuffer commands);
    void recordUploads(const RecordedFrame& frame, FrameSlot& slot);
    void recordCopies(const RecordedFrame& frame, std::span<const RecordedUpload> uploads, FrameSlot& slot);
    void recordPass(const RecordedFrame& frame, size_t index, FrameSlot& slot);
    void runOnHost(const RecordedFrame& frame, size_t index, FrameSlot& slot);
    void recordDispatch(const RecordedFrame& frame, size_t index, FrameSlot& slot);
    void recordSlices(const RecordedFrame& frame, size_t index, const PipelineCache::Pipeline& pipeline,
                      VkDescriptorSet set, FrameSlot& slot);
    double submitSlice(FrameSlot& slot);
    void bind(VkCommandBuffer commands, const PipelineCache::Pipeline& pipeline, VkDescriptorSet set) const;
    VkDescriptorSet writeDescriptors(const RecordedFrame& frame, size_t index, VkDescriptorSetLayout layout,
                                     FrameSlot& slot);
    void checkGroups(const RecordedFrame& frame, size_t index) const;
    void beginLabel(VkCommandBuffer commands, const std::string& name) const;
    void endLabel(VkCommandBuffer commands) const;

    std::shared_ptr<const Context> context_;
    ImagePool images_;
    std::shared_ptr<PipelineCache> pipelines_;
    std::string prefix_;
    std::vector<FrameSlot> slots_;
    std::vector<FrameImage> frameImages_;  ///< by index of the recorded image
    std::vector<BoundPass> bound_;         ///< by number of the pass
    bool foreign_ = false;                 ///< frames are recorded into the caller's commands
    std::vector<PassTime> foreignTimes_;   ///< of the latest frame known to be finished
    std::optional<TimeSlices> slices_;     ///< set: frames can be interrupted
    uint64_t submitted_ = 0;               ///< number of frames so far
    size_t cleared_ = 0;
};

}  // namespace limpid::gpu
